// @ts-check
/** Microphone faults, by the error's name. */
const MICROPHONE = {
  NotAllowedError: "denied",
  SecurityError: "denied",
  NotFoundError: "nodevice",
  OverconstrainedError: "nodevice",
  NotReadableError: "busy",
  AbortError: "busy",
};

/** Faults of the browser's own recogniser, by the error's code. */
const RECOGNITION = {
  "not-allowed": "denied",
  "service-not-allowed": "service",
  "audio-capture": "nodevice",
  "language-not-supported": "language",
  network: "network",
  "no-speech": "nospeech",
};

/**
 * @param {{name?: string, message?: string}} error of `getUserMedia` or of an audio context
 * @returns {string} key of the words with fault and remedy
 */
export function microphoneFault(error) {
  return `voice.fault.${MICROPHONE[error?.name ?? ""] ?? "microphone"}`;
}

/** @param {string} code of a `SpeechRecognitionErrorEvent` @returns {string} key of the words */
export function recognitionFault(code) {
  return `voice.fault.${RECOGNITION[code] ?? "recognition"}`;
}

/**
 * Returns why talking cannot work, known before it is tried.
 * @param {object} known
 * @param {boolean} known.secure whether the page may have a microphone at all
 * @param {string|undefined} known.state the recogniser's state, of section `hearing`
 * @param {boolean|undefined} known.recogniser whether the robot is set up with one
 * @returns {string|null} key of the words
 */
export function standingFault({ secure, recogniser, state }) {
  if (!secure) return "voice.fault.insecure";
  if (recogniser === false || state === "off") return "voice.fault.recogniser";
  return null;
}
