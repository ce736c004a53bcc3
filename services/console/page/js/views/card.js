// @ts-check
import { h, setAttribute, setText } from "../dom.js";
import { icon } from "../icons.js";
import { drawingOf } from "../model/drawing.js";
import { readable } from "../model/ranking.js";
import { objectWords } from "../speak.js";
import { drawObject } from "./drawing.js";
import { pressObject } from "./press.js";

const MARKS = { held: "hand", picking: "arm", halted: "stop", pointed: "arm", delivered: "check" };

/**
 * A card: drawing, label, attributes, bar, percentage, mark. A button that
 * says the object covers it, for the operator.
 * @param {{object: any}} item
 * @param {any} scene
 * @param {any} context
 */
export function makeCard({ object }, scene, context) {
  const { t } = context;
  const drawn = drawObject(drawingOf(object, scene.noun));
  const tags = Object.entries(object.attributes).map(([attribute, value]) =>
    h("span", {
      class: "tag",
      "data-attribute": attribute,
      "data-value": value,
      text: spoken(scene, attribute, value),
    }),
  );
  const meter = {
    class: "bar",
    role: "meter",
    "aria-valuemin": 0,
    "aria-valuemax": 100,
    "aria-label": t("objects.meter", { object: object.label }),
  };
  const name = t("objects.say", { words: objectWords(object) });
  const onclick = () => pressObject(object, context);
  return h(
    "li",
    { class: "card" },
    h("button", { type: "button", class: "card-say", "aria-label": name, title: name, onclick }),
    drawn,
    h(
      "div",
      { class: "card-body" },
      h(
        "p",
        { class: "card-head" },
        h("span", { class: "card-label", text: object.label }),
        h("span", { class: "mark" }),
      ),
      h("p", { class: "tags" }, ...tags),
      h("div", meter, h("i", {})),
    ),
    h("span", { class: "percent", "aria-hidden": "true" }),
  );
}

/** A value as it is said: "on the counter". */
function spoken(scene, attribute, value) {
  const known = scene.attributes.find((one) => one.name === attribute);
  return known?.values.find((one) => one.name === value)?.spoken ?? value;
}

/**
 * @param {HTMLElement} node made by `makeCard`
 * @param {{p: number, mark: string|null, leads: boolean, sayable: boolean}} item
 * @param {{attribute: string, value: string|null}|null} asked
 * @param {any} t
 */
export function updateCard(node, { p, mark, leads, sayable }, asked, t) {
  /** @type {HTMLElement} */ (node.firstElementChild).hidden = !sayable;
  const bar = /** @type {HTMLElement} */ (node.querySelector(".bar"));
  const { sign, share } = readable(p);
  const text = sign + t.percent(share);
  setAttribute(bar, "aria-valuenow", Math.round(p * 1000) / 10);
  setAttribute(bar, "aria-valuetext", text);
  const fill = /** @type {HTMLElement} */ (bar.firstElementChild);
  fill.style.setProperty("transform", `scaleX(${Math.min(1, Math.max(0, p)).toFixed(4)})`);
  setText(/** @type {HTMLElement} */ (node.lastElementChild), text);
  setAttribute(node, "data-mark", mark);
  setAttribute(node, "data-leads", leads);
  setAttribute(node, "data-unlikely", p < 0.02 && mark === null);
  for (const tag of /** @type {NodeListOf<HTMLElement>} */ (node.querySelectorAll(".tag"))) {
    const { attribute, value } = tag.dataset;
    const hit = asked?.attribute === attribute && (asked?.value === null || asked?.value === value);
    setAttribute(tag, "data-asked", hit);
  }
  const place = /** @type {HTMLElement} */ (node.querySelector(".mark"));
  if (place.dataset.mark === (mark ?? "")) return;
  place.dataset.mark = mark ?? "";
  place.replaceChildren(...(mark ? [icon(MARKS[mark], 16), t(`mark.${mark}`)] : []));
}
