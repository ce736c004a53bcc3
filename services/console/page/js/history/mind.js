// @ts-check
import { h, keyed, setAttribute, setText } from "../dom.js";
import { shareWords } from "../model/ranking.js";
import { reasonsView } from "../views/reasons.js";
import { reasonsOf } from "./model.js";

/** Most bars; of more objects the likeliest are shown. */
const BARS_MAX = 12;
/** A smaller change of a probability is not marked. */
const MOVED = 0.005;

/**
 * Belief of the robot and reasons of its decision, after a moment.
 * @param {any} t
 */
export function mindView(t) {
  const bars = h("ul", { class: "past-bars", "aria-label": t("history.belief") });
  const absent = h("p", { class: "past-absent" });
  const title = h("h3", {});
  const reasons = reasonsView(t);
  const { sentence, list, proven } = reasons;
  const why = h("section", { class: "past-why" }, title, sentence, list, proven);
  const none = h("p", { class: "empty", text: t("history.no_reasons") });
  const belief = h("section", {}, h("h3", { text: t("history.belief") }), bars, absent);
  const element = h("div", { class: "past-mind" }, belief, why, none);

  /**
   * @param {import("./model.js").Interaction} past
   * @param {import("./model.js").Step} step
   */
  function draw(past, step) {
    drawBars(bars, past, step, t);
    const share = step.thought?.absent ?? 0;
    absent.hidden = !(share > MOVED);
    setText(absent, t("history.absent", { share: shareWords(share, t) }));
    const decision = step.thought?.decision;
    const isWeighed = (decision?.alternatives.length ?? 0) > 0;
    why.hidden = !isWeighed;
    none.hidden = isWeighed;
    if (!isWeighed) return;
    setText(title, t(decision.type === "ask" ? "why.question" : "why.action"));
    reasons.draw(reasonsOf(decision), decision.pick?.object, { ...past, attributes: [] });
  }
  return { element, draw };
}

function drawBars(bars, past, { thought, before }, t) {
  const all = past.objects.map(({ label }, n) => ({ n, label, p: thought?.belief[n] ?? 0 }));
  // The same objects in every moment, so that no bar moves.
  const best = (n) => Math.max(...past.moments.map(({ thought: it }) => it?.belief[n] ?? 0));
  const most = all.length > BARS_MAX ? all.map(({ n }) => best(n)).toSorted((a, b) => b - a) : [];
  const least = most[BARS_MAX - 1] ?? 0;
  const shown = all.filter(({ n }) => all.length <= BARS_MAX || best(n) >= least);
  const top = Math.max(...shown.map(({ p }) => p), 0);
  keyed(
    bars,
    shown.slice(0, BARS_MAX),
    ({ n }) => `${past.interaction}.${n}`,
    () => {
      const bar = h("span", { class: "bar", "aria-hidden": "true" }, h("span", {}), h("i", {}));
      return h("li", {}, h("span", { class: "bar-name" }), bar, h("span", { class: "bar-share" }));
    },
    (node, { n, label, p }) => {
      const [name, bar, share] = node.children;
      setText(name, label);
      setAttribute(name, "title", label);
      setText(share, shareWords(p, t));
      bar.firstElementChild.style.setProperty("inline-size", `${100 * p}%`);
      // Position a moment before.
      const was = before?.[n] ?? p;
      bar.lastElementChild.style.setProperty("inset-inline-start", `${100 * was}%`);
      setAttribute(bar.lastElementChild, "data-moved", Math.abs(was - p) > MOVED);
      setAttribute(node, "data-best", p === top && p > 0);
    },
  );
}
