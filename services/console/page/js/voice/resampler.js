// @ts-check
/** Zero crossings of the filter on either side: more make its edge steeper. */
const CROSSINGS = 16;
/** Share of the usable band that is kept; the rest is the filter's edge. */
const BAND = 0.92;

/**
 * Brings a stream from one rate to a lower or equal one, with what the lower one cannot hold taken
 * out. It is late by `delay` samples of the old rate.
 */
export class Resampler {
  #step;
  #half;
  #cutoff;
  /** @type {Float32Array} */
  #kept;
  /** Position of the next sample, in samples from the beginning of the kept sound. */
  #at;

  /**
   * @param {number} from samples a second
   * @param {number} to samples a second
   */
  constructor(from, to) {
    this.#step = from / to;
    this.#cutoff = Math.min(1, to / from) * BAND;
    this.#half = Math.ceil(CROSSINGS / this.#cutoff);
    this.#kept = new Float32Array(this.#half);
    this.#at = this.#half;
  }

  /** Samples of the old rate that a sample waits for those behind it. */
  get delay() {
    return this.#half;
  }

  /**
   * @param {Float32Array} samples
   * @returns {Float32Array} as many as they have come to
   */
  push(samples) {
    const all = new Float32Array(this.#kept.length + samples.length);
    all.set(this.#kept);
    all.set(samples, this.#kept.length);
    const made = [];
    while (this.#at + this.#half < all.length) {
      made.push(this.#sampleAt(all, this.#at));
      this.#at += this.#step;
    }
    const spent = Math.max(0, Math.floor(this.#at) - this.#half);
    this.#kept = all.slice(spent);
    this.#at -= spent;
    return Float32Array.from(made);
  }

  /** The low-passed stream at a place between samples. */
  #sampleAt(all, at) {
    const first = Math.max(0, Math.ceil(at - this.#half));
    const last = Math.min(all.length - 1, Math.floor(at + this.#half));
    let sum = 0;
    let weights = 0;
    for (let n = first; n <= last; n += 1) {
      const weight = kernel((n - at) * this.#cutoff, (n - at) / this.#half);
      sum += all[n] * weight;
      weights += weight;
    }
    return sum / weights;
  }
}

/** A sinc under a Blackman window. */
function kernel(crossing, share) {
  const angle = Math.PI * crossing;
  const sinc = Math.abs(angle) < 1e-9 ? 1 : Math.sin(angle) / angle;
  const window = 0.42 + 0.5 * Math.cos(Math.PI * share) + 0.08 * Math.cos(2 * Math.PI * share);
  return sinc * window;
}
