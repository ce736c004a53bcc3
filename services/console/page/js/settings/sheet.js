// @ts-check
import { h } from "../dom.js";
import { icon } from "../icons.js";
import { keep, recall } from "../kept.js";
import { openSheet } from "../sheet.js";
import { LANGUAGES } from "../strings.js";
import { choose, chosen, LOOK } from "./look.js";
import { personField } from "./person.js";

const LANGUAGE_NAMES = { en: "English", de: "Deutsch" };

/**
 * The one sheet with everything that a person can set on this browser.
 * @param {{link: any, store: any, t: (key: string, args?: object) => string}} context
 * @returns {{open: () => void, add: (title: string, ...nodes: Node[]) => HTMLElement}} `add` adds a
 *   section, for a part of the page that is loaded later
 */
export function makeSettings({ link, store, t }) {
  const body = h("div", { class: "settings-body" });
  const close = { type: "button", class: "tool", "aria-label": t("settings.close") };
  const dialog = h(
    "dialog",
    { class: "help settings", "aria-labelledby": "settings-title" },
    h(
      "div",
      { class: "help-head" },
      h("h2", { id: "settings-title", text: t("settings.title") }),
      h("button", { ...close, onclick: () => dialog.close() }, icon("close", 22)),
    ),
    body,
  );
  const add = (title, ...nodes) => {
    const section = h("fieldset", {}, h("legend", { text: title }), ...nodes);
    body.append(section);
    return section;
  };
  add(t("settings.language"), languages(t));
  for (const name of /** @type {(keyof typeof LOOK)[]} */ (Object.keys(LOOK))) {
    add(t(`settings.${name}`), looks(name, t));
  }
  add(t("settings.keys"), keys(t));
  add(t("settings.from"), ...personField(t, () => link.reconnect()));
  document.body.append(dialog);
  return { open: () => openSheet(dialog, store), add };
}

function languages(t) {
  const use = (code) => {
    keep("language", code);
    const address = new URL(location.href);
    address.searchParams.delete("lang");
    location.replace(address);
  };
  return segments(
    "language",
    t.language(),
    LANGUAGES.map((code) => [code, LANGUAGE_NAMES[code] ?? code]),
    use,
  );
}

function looks(name, t) {
  const root = document.documentElement;
  const values = LOOK[name].map((value) => [value, t(`settings.${name}.${value}`)]);
  return segments(name, chosen(name, root), values, (value) => choose(name, value, root, keep));
}

/** Single letters as keys: for those who dictate, or whose keys are pressed by chance, they can be off. */
function keys(t) {
  const onchange = (event) => keep("keys", event.target.checked ? null : "off");
  const box = h("input", { type: "checkbox", checked: recall("keys") !== "off", onchange });
  return h("label", { class: "settings-box" }, box, h("span", { text: t("settings.keys.single") }));
}

/** Buttons of which one is on. */
function segments(name, current, values, choose) {
  const make = ([value, text]) => {
    const onchange = () => choose(value);
    const input = { type: "radio", name: `settings-${name}`, value, checked: value === current };
    const lang = name === "language" ? value : null;
    return h("label", { lang }, h("input", { ...input, onchange }), h("span", { text }));
  };
  return h("div", { class: "segments" }, ...values.map(make));
}
