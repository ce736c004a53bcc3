// @ts-check
const VERSION = 1;
const HEADER = 24;

/** Samples of one frame at most. */
export const FRAME_SAMPLES_MAX = 1_600;

/**
 * A piece of a stream of sound as the server takes it.
 * @param {object} frame
 * @param {number} frame.stream
 * @param {number} frame.takenMs server time of the first sample
 * @param {number} frame.before samples of the stream before this frame
 * @param {Int16Array} frame.samples 16 kHz, one channel
 * @param {boolean} [frame.end] the stream ends with it
 * @param {boolean} [frame.held] the person holds a key while speaking
 * @param {boolean} [frame.echoFree] the robot's own voice is not in it
 * @returns {ArrayBuffer}
 */
export function encode({ stream, takenMs, before, samples, end, held, echoFree }) {
  const buffer = new ArrayBuffer(HEADER + samples.length * 2);
  const view = new DataView(buffer);
  view.setUint8(0, VERSION);
  view.setUint8(1, (end ? 1 : 0) | (held ? 2 : 0) | (echoFree ? 4 : 0));
  view.setUint32(4, stream, true);
  view.setFloat64(8, takenMs, true);
  view.setBigUint64(16, BigInt(before), true);
  samples.forEach((sample, n) => {
    view.setInt16(HEADER + n * 2, sample, true);
  });
  return buffer;
}
