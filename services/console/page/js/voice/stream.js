// @ts-check
import { encode, FRAME_SAMPLES_MAX } from "./frame.js";
import { RATE } from "./sound.js";

/** Bytes that may wait on the connection, two seconds of sound; later sound is left out. */
const BACKLOG_MAX = 64_000;

/** Sound on its way to the robot. */
export class VoiceStream {
  #link;
  #samples = 0;
  #over = false;

  /**
   * @param {{sendBinary: (buffer: ArrayBuffer) => boolean, backlog: number,
   *   toServer: (pageMs: number) => number}} link
   * @param {number} number that no other stream of this page has
   */
  constructor(link, number) {
    this.#link = link;
    this.number = number;
    /** Samples that were left out because the connection is too slow. */
    this.lost = 0;
  }

  /** Returns whether its end was sent. */
  get isOver() {
    return this.#over;
  }

  /**
   * @param {Int16Array} samples
   * @param {number} takenMs page time of the first one
   * @param {{held?: boolean, echoFree?: boolean}} flags
   * @returns {boolean} whether it went out
   */
  send(samples, takenMs, flags) {
    let sent = true;
    for (let from = 0; from < samples.length; from += FRAME_SAMPLES_MAX) {
      const piece = samples.subarray(from, from + FRAME_SAMPLES_MAX);
      const at = takenMs + (from * 1_000) / RATE;
      if (this.#link.backlog > BACKLOG_MAX || !this.#frame(piece, at, flags)) {
        this.lost += piece.length;
        sent = false;
      }
      this.#samples += piece.length;
    }
    return sent;
  }

  /**
   * @param {number} nowMs page time
   * @param {{held?: boolean, echoFree?: boolean}} flags
   */
  end(nowMs, flags) {
    if (this.#over) return;
    this.#over = true;
    this.#frame(new Int16Array(0), nowMs, { ...flags, end: true });
  }

  #frame(samples, takenMs, flags) {
    const { number: stream } = this;
    const header = { stream, takenMs: this.#link.toServer(takenMs), before: this.#samples };
    return this.#link.sendBinary(encode({ ...header, samples, ...flags }));
  }
}
