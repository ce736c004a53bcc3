// @ts-check
/** Samples a second that the robot listens to. */
export const RATE = 16_000;

/** Loudness of silence, decibels below full scale. */
export const QUIETEST_DB = -100;

/**
 * Measures the level of samples.
 * @param {Int16Array} samples
 * @returns {number} decibels below full scale, `QUIETEST_DB` to 0
 */
export function levelDb(samples) {
  let squares = 0;
  for (const sample of samples) squares += sample * sample;
  const power = squares / Math.max(1, samples.length) / (32_768 * 32_768);
  return power > 0 ? Math.max(QUIETEST_DB, 10 * Math.log10(power)) : QUIETEST_DB;
}

/**
 * Share of a level meter that is filled.
 * @param {number} db
 * @returns {number} 0 at -60 dB and below, 1 at -10 dB and above
 */
export function meterShare(db) {
  return Math.min(1, Math.max(0, (db + 60) / 50));
}

/** Cuts a stream of floats into pieces of equal length, as 16-bit samples. */
export class Chunker {
  #piece;
  #filled = 0;

  /** @param {number} size samples of a piece */
  constructor(size) {
    this.#piece = new Int16Array(size);
  }

  /** Samples that wait for their piece to be full. */
  get pending() {
    return this.#filled;
  }

  /**
   * @param {Float32Array} samples -1 to 1; larger ones are clipped
   * @param {(piece: Int16Array, behind: number) => void} take gets each full piece, a new array
   *   each time, and how many of `samples` came behind it
   */
  push(samples, take) {
    for (let n = 0; n < samples.length; n += 1) {
      const clipped = Math.max(-1, Math.min(1, samples[n]));
      this.#piece[this.#filled] = Math.round(clipped * (clipped < 0 ? 32_768 : 32_767));
      this.#filled += 1;
      if (this.#filled === this.#piece.length) {
        const piece = this.#piece;
        this.#piece = new Int16Array(piece.length);
        this.#filled = 0;
        take(piece, samples.length - n - 1);
      }
    }
  }
}
