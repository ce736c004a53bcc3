// @ts-check
/**
 * Lifetime of a message, milliseconds: long enough to include a quick one, short enough for drift.
 */
const WINDOW_MS = 3_000;
/** A stream that is this far off has stood still, milliseconds. */
const JUMP_MS = 1_000;

/**
 * Maps an audio context's processing time to page time by the arrival of its messages: the least
 * delayed recent one counts. That tolerates a busy page and follows a drifting sound card.
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
