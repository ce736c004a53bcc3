// @ts-check
import { h } from "../dom.js";
import { drawingOf } from "../model/drawing.js";
import { drawObject } from "../views/drawing.js";
import { desiredIn } from "./model.js";

/**
 * The desired object: its drawing and its attributes in plain words.
 * @param {any} scene
 * @param {string|undefined} name
 * @param {(key: string) => string} t
 * @returns {HTMLElement}
 */
export function desired(scene, name, t) {
  const found = desiredIn(scene, name);
  if (!found) return h("p", { class: "empty", text: t("study.unknown") });
  const values = found.values.map(({ attribute, spoken }) =>
    h("div", { class: "study-value" }, h("dt", { text: attribute }), h("dd", { text: spoken })),
  );
  return h(
    "div",
    { class: "study-object", "data-object": name },
    h("div", { class: "study-drawing" }, drawObject(drawingOf(found.object, scene.noun))),
    h("dl", { class: "study-values" }, ...values),
  );
}
