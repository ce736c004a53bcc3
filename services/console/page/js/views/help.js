// @ts-check
import { h } from "../dom.js";
import { icon } from "../icons.js";
import { recall } from "../kept.js";
import { answers } from "../model/answers.js";
import { openSheet } from "../sheet.js";
import { press } from "./press.js";

/**
 * The dialog that explains phrases and keys, and the keys themselves.
 * @param {{store: any, link: any, t: any}} context
 * @returns {() => void} opens the dialog
 */
export function mountHelp(context) {
  const { store, t } = context;
  const close = { type: "button", class: "tool", "aria-label": t("help.close") };
  const dialog = h(
    "dialog",
    { class: "help", "aria-labelledby": "help-title" },
    h(
      "div",
      { class: "help-head" },
      h("h2", { id: "help-title", text: t("help.title") }),
      h("button", { ...close, onclick: () => dialog.close() }, icon("close", 22)),
    ),
    h("h3", { text: t("help.say") }),
    h("ul", { class: "help-say" }, ...SAY.map((what) => sayable(what, t))),
    h("h3", { text: t("help.keys") }),
    h("p", { text: t("help.stop") }),
    keys(t),
  );
  document.body.append(dialog);
  const open = () => openSheet(dialog, store);
  addEventListener("keydown", (event) => {
    if (event.defaultPrevented || event.repeat || recall("keys") === "off") return;
    if (event.ctrlKey || event.metaKey || event.altKey || typing(event.target)) return;
    if (document.querySelector("dialog[open]")) return;
    act(event, context, open);
  });
  return open;
}

/** Actions by words, each with its phrases. */
const SAY = ["ask", "answer", "correct", "back", "end", "why"];

function sayable(what, t) {
  const phrases = h("span", {
    class: "help-phrases",
    lang: "en",
    text: t(`help.say.${what}.words`),
  });
  return h("li", {}, `${t(`help.say.${what}`)}: `, phrases);
}

function keys(t) {
  const rows = [
    [["Esc", "Esc"], "keys.stop"],
    [["Esc"], "keys.stop_moving"],
    [["/"], "keys.say"],
    [[t("keys.yes_key")], "keys.yes"],
    [[t("keys.no_key")], "keys.no"],
    [["?"], "keys.help"],
  ];
  return h(
    "dl",
    { class: "keys" },
    ...rows.map(([names, what]) =>
      h(
        "div",
        {},
        h("dt", {}, ...names.map((name) => h("kbd", { text: name }))),
        h("dd", { text: t(what) }),
      ),
    ),
  );
}

/** The action of a single key outside of text fields. */
function act(event, context, open) {
  const { store, t } = context;
  const key = event.key.toLowerCase();
  const given = answers(store.get("dialogue"), store.get("scene")).map(({ text }) => text);
  const yesNo = given.includes("yes");
  if (key === "?") open();
  else if (key === "/") document.getElementById("say-text")?.focus();
  else if (yesNo && key === t("keys.yes_key").toLowerCase()) press("yes", context);
  else if (yesNo && key === t("keys.no_key").toLowerCase()) press("no", context);
  else return;
  event.preventDefault();
}

function typing(target) {
  return (
    target instanceof HTMLElement &&
    (target.isContentEditable || /^(INPUT|TEXTAREA|SELECT)$/.test(target.tagName))
  );
}
