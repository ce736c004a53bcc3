// @ts-check
import { eachFrame, h, keyed, setAttribute, setText } from "../dom.js";
import { drawingOf } from "../model/drawing.js";
import { countOf, readable, strip } from "../model/ranking.js";
import { drawObject } from "./drawing.js";

/** Most objects in a line. */
const MOST = 6;

/**
 * The likeliest objects in one line, each in its place, for pages without room for the list.
 * @param {HTMLElement} element
 * @param {{store: any, t: any}} context
 */
export function mountStrip(element, { store, t }) {
  const list = h("ol", { class: "strip-list", "aria-label": t("objects.heading") });
  element.append(list);

  const draw = eachFrame(() => {
    const scene = store.get("scene");
    const belief = (scene?.objects ?? []).map(({ name }) => store.get("belief")?.[name] ?? 0);
    const best = Math.max(0, ...belief);
    const make = (i) =>
      h(
        "li",
        { class: "strip-item" },
        drawObject(drawingOf(scene.objects[i], scene.noun)),
        h("span", { class: "hidden", lang: "en", text: `${scene.objects[i].label}: ` }),
        h("span", { class: "strip-share" }),
      );
    const update = (node, i) => {
      const { sign, share } = readable(belief[i]);
      setText(node.lastElementChild, sign + t.percent(share));
      setAttribute(node, "data-leads", best > 1.5 / countOf(scene) && belief[i] >= best - 1e-9);
      setAttribute(node, "data-unlikely", belief[i] < 0.02);
    };
    keyed(list, strip(belief, MOST), (i) => `${scene.key} ${scene.objects[i].name}`, make, update);
  });
  store.subscribe(["scene", "belief"], draw);
  draw();
}
