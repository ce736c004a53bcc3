// @ts-check
/** A sound that is less late than this is played from its beginning, milliseconds. */
const LATE_MS = 300;

/**
 * @typedef {{prompt: number, presentation: number, url: string|null, began_ms: number,
 *   state: string}} Speaking
 */

/** @param {Speaking|null|undefined} speaking @returns {string} names one presentation of a prompt */
export function keyOf(speaking) {
  return speaking ? `${speaking.prompt}-${speaking.presentation}` : "";
}

/**
 * What the loudspeaker is to do about what the robot says.
 * @param {object} now
 * @param {Speaking|null|undefined} now.speaking
 * @param {string} now.playing what sounds, as `keyOf`; empty for nothing
 * @param {string} now.hushed what is not to be heard: a person spoke over it
 * @param {boolean} now.muted
 * @returns {{stop: boolean, start: Speaking|null}} `stop` what sounds; `start` this
 */
export function plan({ speaking, playing, hushed, muted }) {
  const key = keyOf(speaking);
  const broken = speaking?.state === "interrupted" || speaking?.state === "silent";
  const wanted = !muted && key !== hushed && !broken;
  // What was said to its end may still sound here for a moment.
  const stop = playing !== "" && !(wanted && playing === key);
  const begins = speaking?.state === "speaking" && Boolean(speaking.url) && playing !== key;
  return { stop, start: wanted && begins ? speaking : null };
}

/**
 * Where in a sound to begin.
 * @param {number} beganMs server time at which it began
 * @param {number} nowMs server time
 * @param {number} lengthS
 * @returns {number|null} seconds from its beginning, null where it is over
 */
export function offsetS(beganMs, nowMs, lengthS) {
  const late = nowMs - beganMs;
  const offset = late < LATE_MS ? 0 : late / 1_000;
  return offset < lengthS ? offset : null;
}
