// @ts-check
import { h, setAttribute } from "../dom.js";
import { icon } from "../icons.js";
import { keep } from "../kept.js";
import { mountHelp } from "./help.js";

const THEMES = ["auto", "light", "dark"];
const DRAWINGS = { auto: "auto", light: "sun", dark: "moon" };

/**
 * Theme and help.
 * @param {HTMLElement} element
 * @param {{store: any, link: any, t: any}} context
 */
export function mountTools(element, context) {
  const { t } = context;
  const theme = h("button", { type: "button", class: "tool", id: "theme" });
  const help = {
    type: "button",
    class: "tool",
    id: "help",
    "aria-label": t("help.open"),
    title: t("help.open"),
  };
  const openHelp = mountHelp(context);
  element.append(theme, h("button", { ...help, onclick: openHelp }, icon("help", 22)));

  let chosen = document.documentElement.dataset.theme ?? "auto";
  theme.addEventListener("click", () => {
    chosen = THEMES[(THEMES.indexOf(chosen) + 1) % THEMES.length];
    if (chosen === "auto") delete document.documentElement.dataset.theme;
    else document.documentElement.dataset.theme = chosen;
    keep("theme", chosen === "auto" ? null : chosen);
    show();
  });
  const show = () => {
    const label = t("theme.label", { theme: t(`theme.${chosen}`) });
    setAttribute(theme, "aria-label", label);
    setAttribute(theme, "title", label);
    theme.replaceChildren(icon(DRAWINGS[chosen], 22));
  };
  show();
}
