// @ts-check
// Who speaks from this browser. The name is kept here alone and is sent with the user's words.
import { h } from "../dom.js";
import { keep, recall } from "../kept.js";

/** Longest name, bytes of UTF-8. */
const BYTES_MAX = 64;

/**
 * The name as it may be sent: without spaces around it and without its end if it is too long.
 * @param {string} text
 */
export function nameOf(text) {
  const bytes = (characters) => new TextEncoder().encode(characters.join("")).length;
  const characters = [...text.trim()];
  while (bytes(characters) > BYTES_MAX) characters.pop();
  return characters.join("").trimEnd();
}

/** The name that was set on this browser; empty for an unnamed person. */
export const whoSpeaks = () => nameOf(recall("from") ?? "");

/**
 * The field for the name, with its use.
 * @param {any} t
 * @param {() => void} renamed the other viewers are to see the new name
 */
export function personField(t, renamed) {
  const hint = h("p", {
    class: "settings-hint",
    id: "settings-from-hint",
    text: t("settings.from.hint"),
  });
  const input = h("input", {
    class: "settings-name",
    type: "text",
    value: whoSpeaks(),
    autocomplete: "off",
    spellcheck: "false",
    "aria-label": t("settings.from"),
    "aria-describedby": hint.id,
    onchange: () => {
      input.value = nameOf(input.value);
      keep("from", input.value || null);
      renamed();
    },
  });
  return [input, hint];
}
