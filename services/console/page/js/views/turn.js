// @ts-check
import { eachFrame, h, setAttribute, setText } from "../dom.js";
import { icon } from "../icons.js";
import { banner, whoControls } from "../model/turn.js";

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
    const who = whoControls(store.get("control"), store.get("welcome"));
    const now = banner(store.get("link"), store.get("turn"), store.get("arm"), who);
    setAttribute(element, "data-tone", now.tone);
    setAttribute(element, "data-state", now.key);
    setText(words, t(`turn.${now.key}`));
    setText(more, t(`turn.${now.key}.more`));
    if (drawn !== now.icon) lamp.replaceChildren(icon(/** @type {any} */ (now.icon), 26));
    drawn = now.icon;
  });
  store.subscribe(["link", "turn", "arm", "control", "welcome"], draw);
  draw();
}
