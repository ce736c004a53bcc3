// @ts-check
/** A sentence that ended so much before its sound was broken off, milliseconds. */
const SHORT_MS = 400;
/** A sound that is less late than this is played from its beginning, milliseconds. */
const LATE_MS = 300;

/**
 * @typedef {{prompt: number, presentation: number, url: string|null, began_ms: number,
 *   ended_ms?: number|null, state: string}} Speaking
 */

/** @param {Speaking|null|undefined} speaking @returns {string} names one presentation of a prompt */
export function keyOf(speaking) {
  return speaking ? `${speaking.prompt}-${speaking.presentation}` : "";
}

/**
 * Schedules the loudspeaker for the robot's current sentence.
 * @param {object} now
 * @param {Speaking|null|undefined} now.speaking
 * @param {string} now.playing the sounding line, as `keyOf`; empty for nothing
 * @param {number} [now.lengthS] how long that sound is
 * @param {string} now.hushed the silenced line: a person spoke over it
 * @param {boolean} now.muted
 * @returns {{stop: boolean, start: Speaking|null}} `stop` the sounding line; `start` this
 */
export function plan({ speaking, playing, lengthS = 0, hushed, muted }) {
  const key = keyOf(speaking);
  const saidMs = (speaking?.ended_ms ?? Infinity) - (speaking?.began_ms ?? 0);
  const short = playing === key && saidMs < lengthS * 1_000 - SHORT_MS;
  const broken = short || speaking?.state === "interrupted" || speaking?.state === "silent";
  const wanted = !muted && key !== hushed && !broken;
  // A finished line may still sound here for a moment.
  const stop = playing !== "" && !(wanted && playing === key);
  const begins = speaking?.state === "speaking" && Boolean(speaking.url) && playing !== key;
  return { stop, start: wanted && begins ? speaking : null };
}

/**
 * Returns the position in a sound at which to begin.
 * @param {number} beganMs server time at which it began
 * @param {number} nowMs server time
 * @param {number} lengthS
 * @returns {number|null} seconds from its beginning, null if it is over
 */
export function offsetS(beganMs, nowMs, lengthS) {
  const late = nowMs - beganMs;
  const offset = late < LATE_MS ? 0 : late / 1_000;
  return offset < lengthS ? offset : null;
}
