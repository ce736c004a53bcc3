// @ts-check
import { addressOf } from "../place.js";
import { keyOf, offsetS, plan } from "./schedule.js";

/** Remembers that the robot is not to be heard here. */
const MUTED = "whichone.voice.muted";
/** Sounds that are kept: a question is often asked again. */
const KEPT_MAX = 8;
/** Buffer between the page and the loudspeaker, seconds: the shortest that the browser has. By default
 *  Chromium's is 42 ms, which a person waits for. */
const LATENCY_S = 0;
/** Name of the measure from the end of a person's words to the first sound of the answer. */
export const REPLY = "voice:reply";

/**
 * Plays the robot's lines.
 * @param {{link: any, store: any, storage: Storage|null, notify: () => void}} context `notify` is called
 *   when `locked`, `muted` or `sounds` has changed
 */
export function playback({ link, store, storage, notify }) {
  return new Playback(link, store, storage, notify);
}

class Playback {
  #link;
  #store;
  #storage;
  #notify;
  /** @type {AudioContext|null} */
  #context = null;
  /** @type {Map<string, Promise<AudioBuffer>>} */
  #sounds = new Map();
  /** @type {{key: string, source: AudioBufferSourceNode|null}} */
  #playing = { key: "", source: null };
  #hushed = "";
  #muted;
  /** Page time at which the person ended whose reply is not measured yet. */
  #endedAt = NaN;
  /** Page time of the first sound of the robot's latest line. */
  #soundedAt = NaN;

  constructor(link, store, storage, notify) {
    this.#link = link;
    this.#store = store;
    this.#storage = storage;
    this.#notify = notify;
    this.#muted = storage?.getItem(MUTED) === "yes";
    store.subscribe("speaking", () => this.#look());
    for (const event of ["pointerdown", "keydown"]) {
      document.addEventListener(event, () => this.unlock(), { capture: true });
    }
  }

  get muted() {
    return this.#muted;
  }

  /** Returns whether the browser mutes it until the person interacts with the page. */
  get locked() {
    return !this.#muted && this.#context?.state === "suspended" && this.#wanted() !== null;
  }

  /** Returns whether the robot is audible now. */
  get sounds() {
    return this.#playing.source !== null;
  }

  /** @param {boolean} muted */
  mute(muted) {
    this.#muted = muted;
    this.#storage?.setItem(MUTED, muted ? "yes" : "no");
    this.#look();
    this.#notify();
  }

  /** The person speaks: the robot is silent here at once, and stays so for that line. */
  hush() {
    this.#hushed = keyOf(this.#store.get("speaking"));
    this.#look();
  }

  /** To be called when the person does something: browsers are silent before that. */
  unlock() {
    if (this.#context?.state !== "suspended") return;
    this.#context.resume().then(
      () => this.#look(),
      () => {},
    );
  }

  /**
   * A person has ended at this page time: the next sound is the answer, which may have
   * arrived before the receipt of the words.
   */
  heard(endedAt) {
    this.#endedAt = endedAt;
    this.#measure();
  }

  #wanted() {
    const speaking = this.#store.get("speaking");
    const { key: playing } = this.#playing;
    return plan({ speaking, playing, hushed: this.#hushed, muted: this.#muted }).start;
  }

  #look() {
    const speaking = this.#store.get("speaking");
    const { key: playing } = this.#playing;
    const lengthS = this.#playing.source?.buffer?.duration;
    const { stop, start } = plan({
      speaking,
      playing,
      lengthS,
      hushed: this.#hushed,
      muted: this.#muted,
    });
    if (stop) this.#stop();
    if (start) void this.#start(start);
  }

  #stop() {
    const { source } = this.#playing;
    this.#playing = { key: "", source: null };
    source?.stop();
    this.#notify();
  }

  async #start(speaking) {
    const key = keyOf(speaking);
    this.#playing = { key, source: null };
    try {
      this.#context ??= new AudioContext({ latencyHint: LATENCY_S });
      const context = this.#context;
      const sound = await this.#sound(speaking.url);
      if (context.state === "suspended") await Promise.race([context.resume(), shortly()]);
      if (this.#playing.key !== key) return;
      const offset = offsetS(speaking.began_ms, this.#link.serverNow(), sound.duration);
      if (context.state !== "running" || offset === null) {
        this.#playing = { key: "", source: null };
        return;
      }
      const source = new AudioBufferSourceNode(context, { buffer: sound });
      source.connect(context.destination);
      source.onended = () => {
        if (this.#playing.source !== source) return;
        // The key stays: it is not to begin again while the robot's clock catches up.
        this.#playing.source = null;
        this.#notify();
      };
      this.#playing.source = source;
      source.start(0, offset);
      const latencyS = context.baseLatency + (context.outputLatency || 0);
      this.#soundedAt = performance.now() + latencyS * 1_000;
      this.#measure();
    } catch (error) {
      console.warn(`${speaking.url}: ${error}`);
    } finally {
      this.#notify();
    }
  }

  /** @param {string} url @returns {Promise<AudioBuffer>} */
  #sound(url) {
    const known = this.#sounds.get(url);
    if (known) return known;
    const sound = load(/** @type {AudioContext} */ (this.#context), url);
    sound.catch(() => this.#sounds.delete(url));
    this.#sounds.set(url, sound);
    const [oldest] = this.#sounds.keys();
    if (this.#sounds.size > KEPT_MAX) this.#sounds.delete(oldest);
    return sound;
  }

  /** From the end of the person's words to the first sound that leaves the loudspeaker. */
  #measure() {
    const [start, end] = [this.#endedAt, this.#soundedAt];
    if (!(end > start)) return;
    this.#endedAt = NaN;
    const { duration } = performance.measure(REPLY, { start: Math.max(0, start), end });
    document.documentElement.dataset.voiceReplyMs = duration.toFixed(0);
  }
}

/** @param {AudioContext} context @param {string} url */
async function load(context, url) {
  const response = await fetch(addressOf(url));
  if (!response.ok) throw new Error(`${response.status} ${response.statusText}`);
  return context.decodeAudioData(await response.arrayBuffer());
}

/** A browser that waits for the person never answers. */
function shortly() {
  return new Promise((resolve) => setTimeout(resolve, 60));
}
