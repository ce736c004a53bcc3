// @ts-check
import { whoControls } from "../model/turn.js";
import { Dictation } from "./dictation.js";
import { microphoneFault, recognitionFault, standingFault } from "./faults.js";
import { idle, pressed, talks } from "./press.js";
import { Recording } from "./recording.js";

/** Sound after the release that belongs to the utterance: the robot ends it with the voice. */
const TAIL_MS = 250;
/** Longest talk after a click. */
const LATCHED_MS = 30_000;

/** @typedef {{key: string, args?: Record<string, any>}} Words key of a text, and its parts */

/** The person's side of the conversation: talking, and its results. */
export class Talk {
  #link;
  #store;
  #playback;
  #notify;
  #choices;
  #press = idle();
  #handsFree = false;
  #recording;
  #dictation;
  #tail = 0;
  #latched = 0;

  /** Current fault, with a hint. @type {Words|null} */
  fault = null;
  /** Current notice. @type {Words|null} */
  note = null;

  /**
   * @param {{link: any, store: any, playback: any, choices: import("./choices.js").Choices,
   *   notify: () => void}} context `notify` is called when anything has changed
   */
  constructor({ link, store, playback, choices, notify }) {
    this.#link = link;
    this.#store = store;
    this.#playback = playback;
    this.#choices = choices;
    this.#notify = notify;
    this.#recording = new Recording(link, {
      choices: () => this.#choices,
      muted: () => playback.muted,
      notify,
      gone: () => this.#fail("voice.fault.gone"),
    });
    this.#dictation = new Dictation({
      language: () => store.get("welcome")?.settings?.language ?? "en",
      partial: (text, at) =>
        store.set("partial", { stream: null, text, onset_ms: link.toServer(at) }),
      heard: (said) => void this.#say(said),
      failed: (code) => this.#unheard(code),
      notify,
    });
    link.on("receipt", (receipt) => this.#receipt(receipt));
    store.subscribe(["link", "control"], () => this.#follow());
  }

  get talks() {
    return talks(this.#press);
  }

  get latched() {
    return this.#press.press === "latched";
  }

  get handsFree() {
    return this.#handsFree;
  }

  get isOpening() {
    return this.#recording.isOpening;
  }

  /** Returns whether a microphone is open. */
  get isOpen() {
    return this.#recording.isOpen || this.#dictation.isOpen;
  }

  get levelDb() {
    return this.#recording.levelDb;
  }

  get slow() {
    return this.#recording.isSending && this.#recording.slow;
  }

  get choices() {
    return this.#choices;
  }

  /** Obstacle to talking, known before it is tried. @returns {string|null} */
  standing() {
    if (this.#choices.engine === "browser") return null;
    const secure = Boolean(globalThis.navigator?.mediaDevices?.getUserMedia);
    const recogniser = this.#store.get("welcome")?.settings?.voice?.recogniser;
    const state = this.#store.get("hearing")?.recogniser;
    return standingFault({ secure, recogniser, state });
  }

  /** @param {"down"|"up"|"click"|"cancel"} event */
  press(event) {
    const before = this.talks;
    this.#press = pressed(this.#press, event, performance.now());
    clearTimeout(this.#latched);
    if (this.latched) this.#latched = window.setTimeout(() => this.press("cancel"), LATCHED_MS);
    if (!before && this.talks) {
      this.#playback.hush();
      void this.#begin();
    }
    if (before && !this.talks) this.#end();
    this.#notify();
  }

  /** @param {boolean} on */
  setHandsFree(on) {
    this.#handsFree = on;
    if (on) void this.#begin();
    else if (!this.talks) this.#end();
    this.#notify();
  }

  /** @param {Partial<import("./choices.js").Choices>} change */
  choose(change) {
    this.#choices = { ...this.#choices, ...change };
    this.#clear();
    this.close();
    if (this.#handsFree) void this.#begin();
    this.#notify();
  }

  /** Closes the microphone. */
  close() {
    clearTimeout(this.#tail);
    this.#dictation.stop();
    this.#recording.close();
  }

  #clear() {
    this.fault = null;
    this.note = null;
  }

  /** @param {string} key @param {Record<string, any>} [args] @returns {false} */
  #fail(key, args) {
    this.fault = { key, args };
    this.#press = idle();
    this.#handsFree = false;
    this.#notify();
    return false;
  }

  async #begin() {
    clearTimeout(this.#tail);
    this.#clear();
    const standing = this.standing();
    if (standing) return this.#fail(standing);
    if (!(await this.#inControl())) return;
    if (this.#choices.engine === "browser") {
      if (!this.#dictation.start()) this.#fail("voice.fault.nobrowser");
    } else if (await this.#open()) {
      this.#recording.held = this.talks;
      if (this.talks || this.#handsFree) this.#recording.send();
      else this.#ready();
    }
    this.#notify();
  }

  /** The microphone was opened for a press that is over: the browser had asked the person first. */
  #ready() {
    this.note = { key: "voice.note.ready" };
    this.#recording.keepWarm();
  }

  /** Talking takes control if there is no operator. */
  async #inControl() {
    const who = whoControls(this.#store.get("control"), this.#store.get("welcome"));
    if (!this.#link.isUp) return this.#fail("voice.fault.link");
    if (who === "theirs" || who === "asked") return this.#fail("voice.fault.watching");
    if (who !== "free") return true;
    try {
      await this.#link.do("take_control");
      return true;
    } catch {
      return this.#fail("voice.fault.watching");
    }
  }

  async #open() {
    try {
      const opened = this.#recording.open();
      this.#notify();
      await opened;
      return true;
    } catch (error) {
      return this.#fail(microphoneFault(error), { reason: error.message });
    }
  }

  #end() {
    clearTimeout(this.#tail);
    if (!this.#handsFree) this.#dictation.stop();
    this.#recording.held = false;
    this.#tail = window.setTimeout(() => {
      if (!this.#handsFree && this.#recording.isSending) this.#recording.end();
      this.#notify();
    }, TAIL_MS);
  }

  /** Applies changes of the connection or of control. */
  #follow() {
    const who = whoControls(this.#store.get("control"), this.#store.get("welcome"));
    if (!this.#link.isUp) {
      this.#recording.lose();
      if (this.talks) this.#fail("voice.fault.link");
    } else if (this.fault?.key === "voice.fault.link") {
      this.fault = null;
    } else if (this.fault?.key === "voice.fault.watching" && (who === "mine" || who === "free")) {
      this.fault = null;
    } else if (this.#recording.isSending && who === "theirs") {
      this.close();
      this.#fail("voice.fault.watching");
    } else if (this.#handsFree && this.#recording.isOpen && who === "mine") {
      this.#recording.send();
    }
    this.#notify();
  }

  #receipt({ stream, status, text, ended_ms: endedMs, utterances }) {
    if (status === "accepted") {
      this.#clear();
      if (endedMs) this.#playback.heard(this.#link.toPage(endedMs));
    } else if (status === "not_for_me") {
      this.note = { key: text ? "voice.note.unmeant" : "voice.note.unclear", args: { text } };
    } else if (status === "refused") {
      this.fault = { key: "voice.fault.refused", args: { reason: text } };
    } else if (stream === this.#recording.number) {
      this.#over(text, utterances);
    }
    this.#notify();
  }

  /** The robot has closed the stream; further sound opens a new one. */
  #over(text, utterances) {
    const goesOn = this.#recording.isSending;
    this.#recording.lose();
    if (goesOn && this.isOpen && (this.talks || this.#handsFree)) return this.#recording.send();
    if (utterances === null) this.fault = { key: "voice.fault.refused", args: { reason: text } };
    else if (utterances === 0) this.note = { key: "voice.note.nothing" };
  }

  #unheard(code) {
    if (code !== "no-speech") this.#fail(recognitionFault(code), { code });
    else if (!this.#handsFree) this.note = { key: "voice.note.nothing" };
    this.#notify();
  }

  async #say({ text, alternatives, beganMs, endedMs }) {
    const [began_ms, ended_ms] = [beganMs, endedMs].map((at) => this.#link.toServer(at));
    try {
      await this.#link.do("say", { text, alternatives, source: "browser", began_ms, ended_ms });
      this.#playback.heard(endedMs);
      this.#clear();
    } catch (error) {
      this.fault = { key: "voice.fault.refused", args: { reason: error.message } };
    }
    this.#notify();
  }
}
