// @ts-check
import { eachFrame, h, keyed, setAttribute, setText } from "../dom.js";
import { actionWords, proof, ranked, toCome } from "../model/reasons.js";

const ONE_DIGIT = { maximumFractionDigits: 1, minimumFractionDigits: 1 };
const NO_DIGIT = { maximumFractionDigits: 0 };
/** Smaller losses are shown as none, seconds; larger ones without a decimal. */
const SMALL_S = 0.05;
const MANY_S = 10;
/** Most actions that are compared. */
const ACTIONS_MAX = 4;

/**
 * The reasons of the decision: the best other actions and what each would lose.
 * @param {HTMLElement} element
 * @param {{store: any, t: any}} context
 */
export function mountWhy(element, { store, t }) {
  const title = h("h2", { id: "why-heading" });
  const sentence = h("p", { class: "why-sentence" });
  const list = h("ol", { class: "why-list" });
  const proven = h("p", { class: "why-proof" });
  element.append(title, sentence, list, proven);

  const lossWords = (loss, isBest) => {
    if (isBest) return t("why.best");
    if (loss < SMALL_S) return t("why.equal");
    return t("why.worse", { s: t.number(loss, loss < MANY_S ? ONE_DIGIT : NO_DIGIT) });
  };
  const words = (action) => {
    const { key, args } = actionWords(action, store.get("scene"));
    return t(key, args);
  };
  const make = () => {
    const bar = h("span", { class: "why-bar", "aria-hidden": "true" }, h("i", {}));
    const name = h("span", { class: "why-name" });
    return h("li", {}, name, bar, h("span", { class: "why-value" }));
  };
  const update = (node, item) => {
    const [name, bar, value] = node.children;
    setText(name, words(item.action));
    setAttribute(name, "title", words(item.action));
    bar.firstElementChild.style.setProperty("transform", `scaleX(${item.length.toFixed(4)})`);
    setText(value, lossWords(item.loss, item.best));
    setAttribute(node, "data-chosen", item.chosen);
    setAttribute(node, "aria-current", item.chosen ? "true" : null);
  };

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
    const { key, args } = toCome(dialogue.expected_questions);
    setText(sentence, t(key, args));
    const aim = store.get("arm")?.object;
    const ordered = ranked(dialogue, aim, ACTIONS_MAX);
    const items = ordered.map((item, i) => ({ ...item, best: i === 0 }));
    keyed(list, items, (item) => JSON.stringify(item.action), make, update);
    const known = proof(dialogue.value, dialogue.bounds);
    const sure = known ? `${t(known.key, known.args)} ` : "";
    setText(proven, sure + t("why.points"));
  });
  store.subscribe(["dialogue", "scene"], draw);
  draw();
}
