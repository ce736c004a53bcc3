// @ts-check
import { h } from "../dom.js";
import { icon } from "../icons.js";
import { makeSettings } from "../settings/sheet.js";
import { mountHelp } from "./help.js";

/**
 * Settings and help; other parts add their own settings to `context.settings`.
 * @param {HTMLElement} element
 * @param {{store: any, link: any, t: any, settings?: ReturnType<typeof makeSettings>}} context
 */
export function mountTools(element, context) {
  const { t } = context;
  context.settings = makeSettings(t);
  const tool = (id, label, drawing, onclick) => {
    const button = {
      type: "button",
      class: "tool",
      id,
      "aria-label": label,
      title: label,
      onclick,
    };
    return h("button", button, icon(drawing, 22));
  };
  element.append(
    tool("settings", t("settings.open"), "settings", context.settings.open),
    tool("help", t("help.open"), "help", mountHelp(context)),
  );
}
