// @ts-check
import { h, setAttribute } from "../dom.js";

const TABS = ["talk", "objects", "arm", "details"];

/**
 * On a phone one part of the page shows at a time; elsewhere all do, and these buttons are not seen.
 * @param {HTMLElement} element
 * @param {HTMLElement} page
 * @param {{t: (key: string) => string}} context
 */
export function mountTabs(element, page, { t }) {
  const show = (tab) => {
    page.dataset.tab = tab;
    for (const button of element.children) {
      setAttribute(button, "aria-pressed", String(button.getAttribute("data-tab") === tab));
    }
  };
  for (const tab of TABS) {
    const button = { type: "button", "data-tab": tab, onclick: () => show(tab) };
    element.append(h("button", { ...button, text: t(`tab.${tab}`) }));
  }
  show(page.dataset.tab ?? "talk");
}
