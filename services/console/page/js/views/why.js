// @ts-check
import { eachFrame, h, setText } from "../dom.js";
import { serviceWords } from "../model/health.js";
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
    const now = store.get("now");
    const decided = dialogue?.interaction > 0 && (dialogue.alternatives?.length ?? 0) > 0;
    const shown = decided && !["disconnected", "held"].includes(now.is);
    list.hidden = proven.hidden = !shown;
    if (!shown) {
      setText(title, t("why.idle"));
      setText(sentence, unknown(now, t) ?? t("why.idle.more"));
      return;
    }
    setText(title, t(dialogue.decision === "ask" ? "why.question" : "why.action"));
    drawReasons(dialogue, now.aim, store.get("scene"));
    if (now.is === "stopped") setText(sentence, t("why.stopped"));
  });
  store.subscribe(["dialogue", "scene", "now"], draw);
}

/** Reason for a missing decision, if there is one. */
function unknown(now, t) {
  if (now.is === "disconnected") return t("question.disconnected");
  return now.is === "held" ? serviceWords(now, t) : null;
}
