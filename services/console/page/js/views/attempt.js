// @ts-check
import { h } from "../dom.js";

/** Display time of a message, milliseconds. */
const STAY_MS = 7_000;

/**
 * Waits for something that was asked of the server; if it fails, says why.
 * @template T
 * @param {Promise<T>} promise
 * @param {{t: (key: string, args?: object) => string}} context
 * @returns {Promise<T|null>} null: it failed
 */
export async function attempt(promise, { t }) {
  try {
    const done = await promise;
    if (/** @type {any} */ (done)?.waits_for) notify(waiting(done, t));
    return done;
  } catch (error) {
    notify(reason(/** @type {any} */ (error), t));
    return null;
  }
}

/**
 * Says that words are kept although nothing follows yet, and why; nothing if all is well.
 * @param {any} done the server's answer to words
 * @param {(key: string, args?: object) => string} t
 */
export function waiting(done, t) {
  return done?.waits_for ? t("say.kept", { why: done.waits_for }) : "";
}

/**
 * Explains a failure in a sentence.
 * @param {{code?: string, message: string}} error
 * @param {(key: string) => string} t
 */
export function reason(error, t) {
  return error.code && error.code !== "refused" ? t(`failed.${error.code}`) : error.message;
}

/**
 * Shows a sentence for some seconds.
 * @param {string} text
 */
export function notify(text) {
  const old = document.querySelector(".toast");
  old?.remove();
  const toast = h("div", { class: "toast", role: "alert", text });
  document.body.append(toast);
  setTimeout(() => toast.remove(), STAY_MS);
}
