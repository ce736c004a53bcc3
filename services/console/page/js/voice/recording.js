// @ts-check
import { isEchoFree } from "./choices.js";
import { Microphone } from "./microphone.js";
import { PreRoll } from "./preroll.js";
import { levelDb, QUIETEST_DB } from "./sound.js";
import { VoiceStream } from "./stream.js";

/** Sound from before the press that belongs to it: people begin to speak as they press. */
const PRE_ROLL_MS = 400;
/** Time for which the microphone stays open for the next press. */
const WARM_MS = 20_000;

/** A microphone and the part of its sound that goes to the robot. */
export class Recording {
  #link;
  #notify;
  /** @type {Microphone|null} */
  #microphone = null;
  /** @type {Promise<void>|null} */
  #opening = null;
  /** @type {VoiceStream|null} */
  #stream = null;
  #number = Math.floor(Math.random() * 2 ** 31);
  #preRoll = new PreRoll(PRE_ROLL_MS);
  #warm = 0;

  /** Loudness, decibels below full scale. */
  levelDb = QUIETEST_DB;
  /** True while the person holds a key. */
  held = false;
  /** True if the connection was too slow for the stream that is sent. */
  slow = false;

  /**
   * @param {any} link
   * @param {{choices: () => import("./choices.js").Choices, muted: () => boolean,
   *   notify: () => void, gone: () => void}} context `gone` is called when the device is taken away
   */
  constructor(link, { choices, muted, notify, gone }) {
    this.#link = link;
    this.#notify = notify;
    this.choices = choices;
    this.muted = muted;
    this.gone = gone;
  }

  get isOpen() {
    return this.#microphone !== null;
  }

  get isOpening() {
    return this.#opening !== null;
  }

  /** Number of the stream that is sent, or was sent last. */
  get number() {
    return this.#number;
  }

  /** Returns whether sound is being sent to the robot. */
  get isSending() {
    return this.#stream !== null;
  }

  /** Opens the microphone; fails as `getUserMedia` does. @returns {Promise<void>} */
  open() {
    clearTimeout(this.#warm);
    if (this.#microphone) return Promise.resolve();
    this.#opening ??= this.#openNow().finally(() => {
      this.#opening = null;
    });
    return this.#opening;
  }

  async #openNow() {
    const { echoCancellation, noiseSuppression, autoGainControl } = this.choices();
    const wishes = { echoCancellation, noiseSuppression, autoGainControl };
    const gone = () => {
      this.close();
      this.gone();
    };
    this.#microphone = await Microphone.open(wishes, (piece) => this.#take(piece), gone);
  }

  /** Sends from now on, and the moment before. */
  send() {
    clearTimeout(this.#warm);
    if (this.#stream) return;
    this.#number += 1;
    this.slow = false;
    this.#stream = new VoiceStream(this.#link, this.#number);
    // The key was not held yet: the robot's own voice may be in it.
    const flags = { ...this.#flags(), held: false };
    for (const { samples, takenMs } of this.#preRoll.take()) {
      this.#stream.send(samples, takenMs, flags);
    }
  }

  /** Sends no more. The microphone stays open for a while. */
  end() {
    this.#stream?.end(performance.now(), this.#flags());
    this.#stream = null;
    this.keepWarm();
  }

  /** Closes the microphone after a while. */
  keepWarm() {
    clearTimeout(this.#warm);
    this.#warm = window.setTimeout(() => this.close(), WARM_MS);
  }

  /** The connection is gone, and with it the server's state of the stream. */
  lose() {
    this.#stream = null;
  }

  close() {
    clearTimeout(this.#warm);
    this.#stream?.end(performance.now(), this.#flags());
    this.#stream = null;
    this.#microphone?.close();
    this.#microphone = null;
    this.#preRoll.take();
    this.levelDb = QUIETEST_DB;
    this.#notify();
  }

  #flags() {
    const measured = this.#microphone?.settings ?? {};
    return { held: this.held, echoFree: isEchoFree(this.choices(), measured, this.muted()) };
  }

  #take({ samples, takenMs }) {
    this.levelDb = levelDb(samples);
    if (!this.#stream) this.#preRoll.push(samples, takenMs);
    else if (!this.#stream.send(samples, takenMs, this.#flags())) this.slow = true;
    this.#notify();
  }
}
