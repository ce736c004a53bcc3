// @ts-check
/** How long a message counts, milliseconds: long enough to meet a quick one, short enough for drift. */
const WINDOW_MS = 3_000;
/** A stream that is this far off has stood still, milliseconds. */
const JUMP_MS = 1_000;

/**
 * Page time of what an audio context processes, from when its messages arrive: the least delayed of
 * late ones tells. That forgives a page that is busy, and follows a sound card that drifts.
 */
export class SampleClock {
  /** @type {{at: number, offset: number}[]} */
  #seen = [];

  /**
   * A message has arrived.
   * @param {number} contextS what it was about, seconds of the context
   * @param {number} nowMs page time
   */
  add(contextS, nowMs) {
    const offset = nowMs - contextS * 1_000;
    if (this.#seen.length && Math.abs(offset - this.offset) > JUMP_MS) this.#seen = [];
    this.#seen = this.#seen.filter(({ at }) => nowMs - at < WINDOW_MS);
    this.#seen.push({ at: nowMs, offset });
  }

  /** Page time of the context's zero, milliseconds. */
  get offset() {
    return Math.min(...this.#seen.map(({ offset }) => offset));
  }

  /**
   * @param {number} contextS
   * @returns {number} page time, milliseconds
   */
  toPage(contextS) {
    return this.offset + contextS * 1_000;
  }
}
