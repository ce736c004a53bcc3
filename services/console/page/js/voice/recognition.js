// @ts-check
/** Words that are offered besides the best ones, at most. */
const ALTERNATIVES_MAX = 4;

/** The browser's own recogniser, if it has one. @returns {any} */
export function recognitionOf(scope = /** @type {any} */ (globalThis)) {
  return scope.SpeechRecognition ?? scope.webkitSpeechRecognition ?? null;
}

/**
 * Returns a result of the browser's recogniser as arguments of `say`.
 * @param {{transcript: string, confidence: number}[]} results best first; a confidence of 0 is unknown
 * @returns {{text: string, alternatives?: {text: string, weight: number}[]}|null} null for no words
 */
export function utterance(results) {
  const texts = new Map();
  for (const { transcript, confidence } of results) {
    const text = transcript.trim();
    if (text) texts.set(text, Math.max(texts.get(text) ?? 0, confidence));
  }
  const [best, ...others] = [...texts];
  if (!best) return null;
  // Without a number of their own the others share the rest of the best one's.
  const rest = (1 - (best[1] || 0.7)) / Math.max(1, others.length);
  const alternatives = others.slice(0, ALTERNATIVES_MAX).map(([text, confidence]) => ({
    text,
    weight: Math.min(0.99, Math.max(0.01, confidence || rest)),
  }));
  return alternatives.length ? { text: best[0], alternatives } : { text: best[0] };
}

/**
 * One session of the browser's recogniser.
 * @param {object} options
 * @param {any} options.Recognition
 * @param {string} options.language
 * @param {boolean} options.continuous
 * @param {(text: string, beganMs: number) => void} options.partial words so far
 * @param {(result: {text: string, alternatives?: object[], beganMs: number, endedMs: number}) =>
 *   void} options.heard
 * @param {(code: string) => void} options.failed
 * @param {() => void} options.ended
 */
export function listen({ Recognition, language, continuous, partial, heard, failed, ended }) {
  const session = new Recognition();
  Object.assign(session, { lang: language, continuous, interimResults: true });
  session.maxAlternatives = ALTERNATIVES_MAX + 1;
  let beganMs = NaN;
  let endedMs = NaN;
  session.onspeechstart = () => {
    beganMs = performance.now();
  };
  session.onspeechend = () => {
    endedMs = performance.now();
  };
  session.onresult = (event) => {
    const now = performance.now();
    if (!(beganMs > 0)) beganMs = now;
    for (const result of [...event.results].slice(event.resultIndex)) {
      const said = utterance([...result]);
      if (!result.isFinal) partial(said?.text ?? "", beganMs);
      else if (said) heard({ ...said, beganMs, endedMs: endedMs > beganMs ? endedMs : now });
      if (result.isFinal) [beganMs, endedMs] = [NaN, NaN];
    }
  };
  session.onerror = (event) => event.error !== "aborted" && failed(event.error);
  session.onend = ended;
  session.start();
  return session;
}
