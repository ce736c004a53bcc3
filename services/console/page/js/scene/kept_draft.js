// @ts-check
import { tabStorage } from "../kept.js";

const KEY = "whichone.scene-draft";

/**
 * Keeps a draft through a reload of the page. @param {import("./draft.js").Draft|null} draft null: forget it
 */
export function keepDraft(draft) {
  try {
    const storage = tabStorage();
    if (!draft) return storage?.removeItem(KEY);
    const { name, text, hash, document, saved } = draft;
    storage?.setItem(KEY, JSON.stringify({ name, text, hash, document, saved }));
  } catch {
    // The storage is full, or refused: it is not kept, then.
  }
}

/** @returns {any} the stored draft, or null */
export function keptDraft() {
  try {
    return JSON.parse(tabStorage()?.getItem(KEY) ?? "null");
  } catch {
    return null;
  }
}
