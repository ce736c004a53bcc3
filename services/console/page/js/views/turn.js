// @ts-check
import { eachFrame, h, setAttribute, setText } from "../dom.js";
import { icon } from "../icons.js";
import { serviceWords } from "../model/health.js";
import { banner } from "../model/turn.js";

/**
 * The sign that says whose turn it is.
 * @param {HTMLElement} element
 * @param {{store: any, t: (key: string) => string}} context
 */
export function mountTurn(element, { store, t }) {
  const lamp = h("span", { class: "turn-lamp" });
  const words = h("strong", { class: "turn-words" });
  const more = h("span", { class: "turn-more" });
  element.append(lamp, h("span", { class: "turn-text" }, words, more));
  let drawn = "";

  const draw = eachFrame(() => {
    const now = store.get("now");
    const sign = banner(now);
    setAttribute(element, "data-tone", sign.tone);
    setAttribute(element, "data-state", sign.key);
    setText(words, t(`turn.${sign.key}`));
    setText(more, now.service ? serviceWords(now, t) : t(`turn.${sign.key}.more`));
    if (drawn !== sign.icon) lamp.replaceChildren(icon(/** @type {any} */ (sign.icon), 26));
    drawn = sign.icon;
  });
  store.subscribe("now", draw);
}
