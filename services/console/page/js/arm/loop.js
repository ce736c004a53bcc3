// @ts-check
/** Time after which a still picture is drawn once more, finely, milliseconds. */
const STILL_MS = 140;

/** When the picture is drawn: in a frame of the browser's, and only if something has changed. */
export class Loop {
  #does;
  #isChanged = false;
  #frame = 0;
  /** @type {any} */
  #still = 0;

  /**
   * @param {object} does
   * @param {() => boolean} does.isShown whether anybody can see the picture
   * @param {(at: number) => boolean} does.draw draws quickly; whether something still moves
   * @param {() => void} does.drawFinely draws the still picture
   */
  constructor(does) {
    this.#does = does;
  }

  /** Has a frame be drawn. */
  request() {
    this.#isChanged = true;
    clearTimeout(this.#still);
    this.#drawSoon();
  }

  /** Schedules drawing for the next animation frame; frames that are not shown are skipped. */
  #drawSoon() {
    if (this.#frame || !this.#does.isShown()) return;
    this.#frame = requestAnimationFrame((at) => {
      this.#frame = 0;
      if (!this.#does.isShown()) return;
      if (this.#isChanged) this.#draw(at);
      else this.#does.drawFinely();
    });
  }

  #draw(at) {
    this.#isChanged = false;
    if (this.#does.draw(at)) this.request();
    else if (!this.#isChanged) this.#still = setTimeout(() => this.#drawSoon(), STILL_MS);
  }
}
