// @ts-check
/** Delay before a picture that did not load is tried again, milliseconds. */
const RETRY_MS = 4_000;

/**
 * Has an image show a camera: a stream, or single pictures one after the other. What does not load is
 * tried again.
 */
export class Feed {
  #image;
  #camera;
  #changed;
  #clock;
  /** @type {any} */
  #timer = null;
  #isOn = false;

  /**
   * @param {HTMLImageElement} image
   * @param {{url: string, every_ms: number|null}} camera `every_ms`: null for a stream
   * @param {(state: "waiting"|"shown"|"failed") => void} changed
   * @param {{setTimeout: Function, clearTimeout: Function, now: () => number}} [clock]
   */
  constructor(image, camera, changed, clock) {
    this.#image = image;
    this.#camera = camera;
    this.#changed = changed;
    this.#clock = clock ?? {
      setTimeout: (f, ms) => setTimeout(f, ms),
      clearTimeout: (timer) => clearTimeout(timer),
      now: () => Date.now(),
    };
    image.addEventListener("load", () => this.#loaded());
    image.addEventListener("error", () => this.#failed());
  }

  /** Begins to fetch pictures. */
  start() {
    if (this.#isOn) return;
    this.#isOn = true;
    this.#changed("waiting");
    this.#fetch();
  }

  /** Ends it, so that a camera without viewers sends nothing. */
  stop() {
    this.#isOn = false;
    this.#clock.clearTimeout(this.#timer);
    this.#image.removeAttribute("src");
  }

  #fetch() {
    if (!this.#isOn) return;
    const { url, every_ms } = this.#camera;
    this.#image.src = every_ms === null ? url : addressOf(url, this.#clock.now());
  }

  #loaded() {
    if (!this.#isOn) return;
    this.#changed("shown");
    if (this.#camera.every_ms !== null) this.#fetchAfter(this.#camera.every_ms);
  }

  #failed() {
    if (!this.#isOn) return;
    this.#changed("failed");
    this.#fetchAfter(RETRY_MS);
  }

  #fetchAfter(ms) {
    this.#clock.clearTimeout(this.#timer);
    this.#timer = this.#clock.setTimeout(() => this.#fetch(), ms);
  }
}

/**
 * The address of a single picture that no cache has.
 * @param {string} url
 * @param {number} at distinguishes it from others
 */
export function addressOf(url, at) {
  const address = new URL(url);
  address.searchParams.set("at", String(at));
  return address.href;
}
