// @ts-check
import { RATE } from "./sound.js";

/** The latest sound of a microphone that is open but not listened to. */
export class PreRoll {
  #pieces = [];
  #max;

  /** @param {number} ms how much of it is kept */
  constructor(ms) {
    this.#max = (ms * RATE) / 1_000;
  }

  /**
   * @param {Int16Array} samples
   * @param {number} takenMs page time of the first one
   */
  push(samples, takenMs) {
    this.#pieces.push({ samples, takenMs });
    let length = this.#pieces.reduce((sum, piece) => sum + piece.samples.length, 0);
    while (length - this.#pieces[0].samples.length >= this.#max) {
      length -= this.#pieces.shift().samples.length;
    }
  }

  /** Takes the stored samples, oldest first. @returns {{samples: Int16Array, takenMs: number}[]} */
  take() {
    const pieces = this.#pieces;
    this.#pieces = [];
    return pieces;
  }
}
