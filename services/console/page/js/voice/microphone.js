// @ts-check
import { SampleClock } from "./clock.js";
import { RATE } from "./sound.js";

/**
 * @typedef {{samples: Int16Array, takenMs: number}} Piece of sound; `takenMs` is page time of its
 *   first sample
 * @typedef {{echoCancellation: boolean, noiseSuppression: boolean, autoGainControl: boolean}} Wishes
 */

/** An open microphone. */
export class Microphone {
  #context;
  #stream;

  /**
   * Opens it.
   * @param {Wishes} wishes
   * @param {(piece: Piece) => void} take
   * @param {() => void} gone called when the device is taken away
   * @returns {Promise<Microphone>} fails as `getUserMedia` does
   */
  static async open(wishes, take, gone) {
    const audio = { ...wishes, channelCount: 1 };
    const stream = await navigator.mediaDevices.getUserMedia({ audio });
    try {
      const { context, source } = await sourceOf(stream);
      const [track] = stream.getAudioTracks();
      track.onended = gone;
      const worklet = new AudioWorkletNode(context, "whichone-capture", { numberOfOutputs: 0 });
      const clock = new SampleClock();
      const { latency } = /** @type {any} */ (track.getSettings());
      const inside = ((latency ?? 0) + context.baseLatency) * 1_000;
      worklet.port.onmessage = ({ data: { samples, endS } }) => {
        clock.add(endS, performance.now());
        const takenMs = clock.toPage(endS) - inside - (samples.length * 1_000) / RATE;
        take({ samples, takenMs });
      };
      source.connect(worklet);
      return new Microphone(context, stream);
    } catch (error) {
      for (const track of stream.getTracks()) track.stop();
      throw error;
    }
  }

  /** @param {AudioContext} context @param {MediaStream} stream */
  constructor(context, stream) {
    this.#context = context;
    this.#stream = stream;
  }

  /** Settings that the browser really applies to the sound. @returns {MediaTrackSettings} */
  get settings() {
    return this.#stream.getAudioTracks()[0].getSettings();
  }

  /** The device's name, as the system calls it. */
  get name() {
    return this.#stream.getAudioTracks()[0].label;
  }

  close() {
    for (const track of this.#stream.getTracks()) track.stop();
    void this.#context.close();
  }
}

/** A context at the robot's rate; if the browser refuses it, one at the device's own. */
async function sourceOf(stream) {
  for (const options of [{ sampleRate: RATE }, {}]) {
    const context = new AudioContext({ ...options, latencyHint: "interactive" });
    try {
      const source = new MediaStreamAudioSourceNode(context, { mediaStream: stream });
      await context.audioWorklet.addModule(new URL("./worklet.js", import.meta.url));
      await context.resume();
      return { context, source };
    } catch (error) {
      await context.close();
      if (!options.sampleRate || error.name !== "NotSupportedError") throw error;
    }
  }
  throw new Error("unreachable");
}
