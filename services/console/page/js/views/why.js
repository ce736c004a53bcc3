// @ts-check
import { eachFrame, h, keyed, setAttribute, setText } from "../dom.js";
import { proof, ranked, toCome } from "../model/reasons.js";

/** Where there is room, the reasons are shown from the beginning. */
const ROOMY = "(min-width: 1024px) and (min-height: 700px)";

/**
 * Why the robot does what it does: what else it could do, and what each is worth.
 * @param {HTMLElement} element
 * @param {{store: any, t: any}} context
 */
export function mountWhy(element, { store, t }) {
  const summary = h("summary", {});
  const sentence = h("p", { class: "why-sentence" });
  const list = h("ol", { class: "why-list" });
  const proven = h("p", { class: "why-proof" });
  const body = h("div", { class: "why-body" }, sentence, list, proven);
  const details = h("details", {}, summary, body);
  details.open = matchMedia(ROOMY).matches;
  element.append(details);

  const words = (action) => t(`action.${action.kind}`, { text: action.text });
  const make = () => {
    const bar = h("span", { class: "why-bar" }, h("i", {}));
    const name = h("span", { class: "why-name" });
    return h("li", {}, name, bar, h("span", { class: "why-value" }));
  };
  const update = (node, item) => {
    const [name, bar, value] = node.children;
    setText(name, words(item.action));
    bar.firstElementChild.style.setProperty("transform", `scaleX(${item.length.toFixed(4)})`);
    setText(value, t.number(item.value, { maximumFractionDigits: 1, minimumFractionDigits: 1 }));
    setAttribute(node, "data-chosen", item.chosen);
    setAttribute(node, "aria-current", item.chosen ? "true" : null);
  };

  const draw = eachFrame(() => {
    const dialogue = store.get("dialogue");
    const shown = dialogue?.interaction > 0 && (dialogue.alternatives?.length ?? 0) > 0;
    details.hidden = !shown;
    if (!shown) return;
    setText(summary, t(dialogue.decision === "ask" ? "why.question" : "why.action"));
    const { key, args } = toCome(dialogue.expected_questions);
    setText(sentence, `${t(key, args)} ${t("why.points")}`);
    const items = ranked(dialogue, store.get("scene"), store.get("arm")?.object);
    keyed(list, items, (item) => `${item.action.kind} ${item.action.text}`, make, update);
    const known = proof(dialogue.value, dialogue.bounds);
    proven.hidden = !known;
    if (known) setText(proven, t(known.key, known.args));
  });
  store.subscribe(["dialogue", "scene"], draw);
  draw();
}
