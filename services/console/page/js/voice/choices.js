// @ts-check
const KEY = "whichone.voice";

/**
 * A person's voice settings.
 * @typedef {object} Choices
 * @property {"robot"|"browser"} engine who recognises
 * @property {boolean} headset the robot's voice does not reach the microphone
 * @property {boolean} echoCancellation
 * @property {boolean} noiseSuppression
 * @property {boolean} autoGainControl
 */

/**
 * The robot takes out noise itself, and misses the parts of a voice that a browser removes; echo
 * only the browser can remove, since it knows its own sound.
 * @type {Choices}
 */
export const DEFAULTS = {
  engine: "robot",
  headset: false,
  echoCancellation: true,
  noiseSuppression: false,
  autoGainControl: true,
};

/** @param {Storage|null} storage @returns {Choices} */
export function kept(storage) {
  const choices = { ...DEFAULTS };
  try {
    const found = JSON.parse(storage?.getItem(KEY) ?? "{}");
    for (const name of Object.keys(DEFAULTS)) {
      if (typeof found?.[name] === typeof DEFAULTS[name]) choices[name] = found[name];
    }
  } catch {
    // Invalid stored values are ignored.
  }
  if (choices.engine !== "browser") choices.engine = "robot";
  return choices;
}

/** @param {Storage|null} storage @param {Choices} choices */
export function keep(storage, choices) {
  storage?.setItem(KEY, JSON.stringify(choices));
}

/**
 * Returns whether a person may interrupt the robot by speaking: its voice is not in the microphone.
 * @param {Choices} choices
 * @param {MediaTrackSettings} measured the browser's settings, not the requested ones
 * @param {boolean} muted whether the robot is silent on this page; then it may sound elsewhere
 */
export function isEchoFree(choices, measured, muted) {
  return choices.headset || (measured.echoCancellation === true && !muted);
}
