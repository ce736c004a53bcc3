// @ts-check
import { eachFrame, h, setText } from "../dom.js";
import { reasonsView } from "./reasons.js";

/**
 * The reasons of the decision in force.
 * @param {HTMLElement} element
 * @param {{store: any, t: any}} context
 */
export function mountWhy(element, { store, t }) {
  const title = h("h2", { id: "why-heading" });
  const { sentence, list, proven, draw: drawReasons } = reasonsView(t);
  element.append(title, sentence, list, proven);

  const draw = eachFrame(() => {
    const dialogue = store.get("dialogue");
    const shown = dialogue?.interaction > 0 && (dialogue.alternatives?.length ?? 0) > 0;
    list.hidden = proven.hidden = !shown;
    if (!shown) {
      setText(title, t("why.idle"));
      setText(sentence, t("why.idle.more"));
      return;
    }
    setText(title, t(dialogue.decision === "ask" ? "why.question" : "why.action"));
    drawReasons(dialogue, store.get("arm")?.object, store.get("scene"));
  });
  store.subscribe(["dialogue", "scene"], draw);
  draw();
}
