// @ts-check
/** Lifetime of a measured round trip, milliseconds. */
const WINDOW_MS = 30_000;
/** Most round trips kept. */
const SAMPLES_MAX = 32;

/**
 * The server's clock, as seen from the page: the offset of the least round trip of late. The least
 * one had the least to wait for on its way, so its middle is nearest to the truth.
 */
export class Clock {
  /** @type {{at: number, trip: number, offset: number}[]} */
  #samples = [];
  #offset = 0;
  #trip = Number.POSITIVE_INFINITY;

  /**
   * Takes in an answer of the server.
   * @param {number} sentMs page time of the request
   * @param {number} heardMs page time of the answer
   * @param {number} serverMs server time in the answer
   */
  add(sentMs, heardMs, serverMs) {
    const trip = heardMs - sentMs;
    if (!(trip >= 0) || !Number.isFinite(serverMs)) return;
    const offset = serverMs - (sentMs + heardMs) / 2;
    this.#samples = this.#samples.filter((sample) => heardMs - sample.at <= WINDOW_MS);
    if (this.#samples.length === SAMPLES_MAX) this.#samples.shift();
    this.#samples.push({ at: heardMs, trip, offset });
    const best = this.#samples.reduce((a, b) => (b.trip <= a.trip ? b : a));
    this.#offset = best.offset;
    this.#trip = best.trip;
  }

  /** Forgets everything: the next server may have another clock. */
  clear() {
    this.#samples = [];
    this.#trip = Number.POSITIVE_INFINITY;
  }

  /** Server time less page time, milliseconds; 0 before the first answer. */
  get offset() {
    return this.#offset;
  }

  /** The least round trip of late, milliseconds; infinite before the first answer. */
  get tripMs() {
    return this.#trip;
  }
}
