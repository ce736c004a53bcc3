// @ts-check
// Storage of the browser for this page. Some private windows refuse; the page works without.
const PREFIX = "whichone.";

/**
 * @param {string} key
 * @returns {string|null}
 */
export function recall(key) {
  try {
    return localStorage.getItem(PREFIX + key);
  } catch {
    return null;
  }
}

/**
 * @param {string} key
 * @param {string|null} value null: forget it
 */
export function keep(key, value) {
  try {
    if (value === null) localStorage.removeItem(PREFIX + key);
    else localStorage.setItem(PREFIX + key, value);
  } catch {
    // It is not kept, then.
  }
}

/** The language that was chosen on this browser. */
export function keptLanguage() {
  return recall("language");
}

/** The tab's own storage, null if it is refused. */
export function tabStorage() {
  try {
    return sessionStorage;
  } catch {
    return null;
  }
}
