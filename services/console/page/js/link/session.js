// @ts-check
const KEY = "whichone.session";

/**
 * The name of this tab towards the server: 32 hexadecimal digits that a reload keeps.
 * @param {Storage|null} storage null: not kept
 * @returns {string}
 */
export function sessionId(storage) {
  const kept = attempt(() => storage?.getItem(KEY));
  if (kept && /^[0-9a-f]{32}$/.test(kept)) return kept;
  const bytes = crypto.getRandomValues(new Uint8Array(16));
  const made = [...bytes].map((byte) => byte.toString(16).padStart(2, "0")).join("");
  attempt(() => storage?.setItem(KEY, made));
  return made;
}

/** Storage is refused in some private windows; the page works without. */
function attempt(f) {
  try {
    return f();
  } catch {
    return null;
  }
}
