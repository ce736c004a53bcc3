// @ts-check
import { listen, recognitionOf } from "./recognition.js";

/** Sessions of the browser's recogniser that may end at once, in a row, before it is left alone. */
const VAIN_MAX = 3;
/** A session that lasts shorter has ended at once, milliseconds. */
const VAIN_MS = 500;

/** The browser's own recogniser, going on for as long as it is wanted. */
export class Dictation {
  #session = null;
  #wanted = false;
  #vain = 0;

  /**
   * @param {{language: () => string, partial: (text: string, beganMs: number) => void,
   *   heard: (said: any) => void, failed: (code: string) => void, notify: () => void}} context
   */
  constructor(context) {
    this.context = context;
  }

  get isOpen() {
    return this.#session !== null;
  }

  /** @returns {boolean} whether this browser has one */
  start() {
    this.#wanted = true;
    return this.#session !== null || this.#next();
  }

  /** Takes the words so far and ends. */
  stop() {
    this.#wanted = false;
    this.#session?.stop();
  }

  #next() {
    const Recognition = recognitionOf();
    if (!Recognition) return false;
    const { language, partial, heard, failed, notify } = this.context;
    const began = performance.now();
    const fail = (code) => {
      // Silence is not a fault while no speech is expected.
      if (code !== "no-speech") this.#wanted = false;
      failed(code);
    };
    const ended = () => {
      this.#session = null;
      partial("", began);
      this.#vain = performance.now() - began < VAIN_MS ? this.#vain + 1 : 0;
      if (this.#wanted && this.#vain < VAIN_MAX) this.#next();
      notify();
    };
    const continuous = true;
    const options = { Recognition, language: language(), continuous, partial, heard };
    this.#session = listen({ ...options, failed: fail, ended });
    return true;
  }
}
