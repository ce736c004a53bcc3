// @ts-check
import { h, keyed, setAttribute, setText } from "../dom.js";
import { shareWords } from "../model/ranking.js";
import { actionWords, gist, proof, ranked, toCome } from "../model/reasons.js";

const ONE_DIGIT = { maximumFractionDigits: 1, minimumFractionDigits: 1 };
const NO_DIGIT = { maximumFractionDigits: 0 };
/** Smaller losses are shown as none, seconds; larger ones without a decimal. */
const SMALL_S = 0.05;
const MANY_S = 10;
/** Most actions that are compared. */
const ACTIONS_MAX = 4;

/**
 * The reasons of a decision: the best other actions and the loss of each.
 * @param {any} t
 */
export function reasonsView(t) {
  const sentence = h("p", { class: "why-sentence" });
  const list = h("ol", { class: "why-list" });
  const figures = h("p", { class: "why-proof" });
  // For those who want it: the sentence above has the essence.
  const proven = h(
    "details",
    { class: "why-more" },
    h("summary", { text: t("why.more") }),
    figures,
  );

  const lossWords = (loss, isBest) => {
    if (isBest) return t("why.best");
    if (loss < SMALL_S) return t("why.equal");
    return t("why.worse", { s: t.number(loss, loss < MANY_S ? ONE_DIGIT : NO_DIGIT) });
  };
  const gistWords = (known) => {
    if (!known) return "";
    const { p = 0, ...args } = known.args;
    return t(known.key, { ...args, share: shareWords(p, t) });
  };
  const make = () => {
    const bar = h("span", { class: "why-bar", "aria-hidden": "true" }, h("i", {}));
    const name = h("span", { class: "why-name" });
    return h("li", {}, name, bar, h("span", { class: "why-value" }));
  };
  const update = (node, item, scene) => {
    const { key, args } = actionWords(item.action, scene);
    const words = t(key, args);
    const [name, bar, value] = node.children;
    setText(name, words);
    setAttribute(name, "title", words);
    bar.firstElementChild.style.setProperty("transform", `scaleX(${item.length.toFixed(4)})`);
    setText(value, lossWords(item.loss, item.best));
    setAttribute(node, "data-chosen", item.chosen);
    setAttribute(node, "aria-current", item.chosen ? "true" : null);
  };

  /**
   * @param {any} dialogue the decision with its alternatives
   * @param {string|null} aim name of the object that is fetched
   * @param {any} scene for the names
   */
  function draw(dialogue, aim, scene) {
    const { key, args } = toCome(dialogue.expected_questions);
    const first = gistWords(gist(dialogue, aim, scene));
    setText(sentence, [first, t(key, args)].filter(Boolean).join(" "));
    const ordered = ranked(dialogue, aim, ACTIONS_MAX);
    const items = ordered.map((item, i) => ({ ...item, best: i === 0 }));
    keyed(
      list,
      items,
      (item) => JSON.stringify(item.action),
      make,
      (node, item) => update(node, item, scene),
    );
    const known = proof(dialogue.value, dialogue.bounds);
    const sure = known ? `${t(known.key, known.args)} ` : "";
    setText(figures, sure + t("why.points"));
  }
  return { sentence, list, proven, draw };
}
