// @ts-check
import { Resampler } from "./resampler.js";
import { Chunker, RATE } from "./sound.js";

/** Samples of a piece: 20 ms, so that the end of a voice arrives soon. */
const PIECE = 320;

const scope = /** @type {any} */ (globalThis);

/** Posts the microphone's sound in pieces, each with its last sample's time of processing. */
class Capture extends scope.AudioWorkletProcessor {
  #chunker = new Chunker(PIECE);
  #resampler = scope.sampleRate === RATE ? null : new Resampler(scope.sampleRate, RATE);

  /** @param {Float32Array[][]} inputs */
  process(inputs) {
    const [channels] = inputs;
    if (!channels?.length) return true;
    const mono = channels.length === 1 ? channels[0] : mixed(channels);
    const samples = this.#resampler ? this.#resampler.push(mono) : mono;
    const endS = (scope.currentFrame + mono.length) / scope.sampleRate;
    const delayS = (this.#resampler?.delay ?? 0) / scope.sampleRate;
    this.#chunker.push(samples, (piece, behind) => {
      const message = { samples: piece, endS: endS - delayS - behind / RATE };
      /** @type {any} */ (this).port.postMessage(message, [piece.buffer]);
    });
    return true;
  }
}

/** @param {Float32Array[]} channels */
function mixed(channels) {
  const mono = new Float32Array(channels[0].length);
  for (const channel of channels) {
    for (let n = 0; n < mono.length; n += 1) mono[n] += channel[n] / channels.length;
  }
  return mono;
}

scope.registerProcessor("whichone-capture", Capture);
