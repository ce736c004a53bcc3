// @ts-check
import { h } from "../dom.js";
import { icon } from "../icons.js";
import { makeSettings } from "../settings/sheet.js";
import { mountHelp } from "./help.js";

/**
 * A button with an icon.
 * @param {string} id
 * @param {string} label
 * @param {Parameters<typeof icon>[0]} drawing
 * @param {() => void} onclick
 */
export function toolButton(id, label, drawing, onclick) {
  const button = { type: "button", class: "tool", id, "aria-label": label, title: label, onclick };
  return h("button", button, icon(drawing, 22));
}

/**
 * Settings and help; other parts add their own settings to `context.settings`.
 * @param {HTMLElement} element
 * @param {{store: any, link: any, t: any, settings?: ReturnType<typeof makeSettings>}} context
 */
export function mountTools(element, context) {
  const { t } = context;
  context.settings = makeSettings(context);
  element.append(
    toolButton("settings", t("settings.open"), "settings", context.settings.open),
    toolButton("help", t("help.open"), "help", mountHelp(context)),
  );
}
