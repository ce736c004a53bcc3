// @ts-check
/** Time for which Resume must be held, milliseconds. */
export const HOLD_MS = 1_000;
/** Time after a press of STOP, Escape or Space in which no hold begins, milliseconds. */
export const QUIET_MS = 2_000;
/**
 * Most that one step adds, milliseconds. A busy page sees a release late: a hold takes many steps, and
 * between two of them the browser delivers events.
 */
const STEP_MS = 100;

/**
 * Decides when a held control releases the motion stop. Pure: times are the caller's, milliseconds.
 * Whoever hammers on STOP must never release it, wherever the finger or the focus lands.
 */
export class Hold {
  #pressedAt = Number.NEGATIVE_INFINITY;
  #steppedAt = 0;
  /** @type {number|null} duration so far; null while nothing is held */
  #heldMs = null;

  /** Notes a press of STOP, Escape or Space: a running hold is cancelled, the next one has to wait. */
  press(now) {
    this.#pressedAt = now;
    this.#heldMs = null;
  }

  /** Returns whether a hold may begin. */
  isFree(now) {
    return now - this.#pressedAt >= QUIET_MS;
  }

  /**
   * Begins a hold, if it may begin. Space is one of the keys that hold, and a press like any other for the
   * next hold.
   * @param {number} now
   * @param {boolean} [bySpace]
   * @returns {boolean} whether it has begun
   */
  begin(now, bySpace = false) {
    const begins = this.isFree(now) && this.#heldMs === null;
    if (bySpace) this.press(now);
    if (begins) [this.#heldMs, this.#steppedAt] = [0, now];
    return begins;
  }

  /** Ends the hold: the finger or the key is up. */
  end() {
    this.#heldMs = null;
  }

  /**
   * Lets time pass.
   * @param {number} now
   * @returns {boolean} whether it was held long enough, once for each hold
   */
  step(now) {
    if (this.#heldMs === null) return false;
    this.#heldMs += Math.min(STEP_MS, Math.max(0, now - this.#steppedAt));
    this.#steppedAt = now;
    if (this.#heldMs < HOLD_MS) return false;
    this.#heldMs = null;
    return true;
  }

  /** The part of the hold that has passed, 0 to 1; null while nothing is held. */
  get share() {
    return this.#heldMs === null ? null : this.#heldMs / HOLD_MS;
  }
}
