// @ts-check
import { h, keyed, setAttribute, setText } from "../dom.js";
import { icon } from "../icons.js";
import { shareWords } from "../model/ranking.js";
import { actorOf, eventWords } from "./model.js";

const DRAWINGS = {
  person: "person",
  arm: "arm",
  stop: "stop",
  release: "play",
  end: "check",
  system: "history",
};
const ONE_DIGIT = { minimumFractionDigits: 1, maximumFractionDigits: 1 };

/**
 * Events of an interaction, in the order of time; each moment can be chosen.
 * @param {any} t
 * @param {(step: number) => void} choose
 */
export function storyView(t, choose) {
  const element = h("ol", { class: "story", "aria-label": t("history.timeline") });

  /**
   * @param {import("./model.js").Interaction} past
   * @param {import("./model.js").Step[]} steps
   * @param {number} current
   */
  function draw(past, steps, current) {
    const rows = steps.map((step, k) => ({ step, k }));
    keyed(
      element,
      rows,
      ({ k }) => `${past.interaction}.${k}`,
      ({ k }) => row(() => choose(k)),
      (node, { step, k }) => fill(node, past, step, k === current, t),
    );
  }
  function reveal(focus) {
    const current = element.querySelector('[aria-current="step"]');
    if (!(current instanceof HTMLElement)) return;
    current.scrollIntoView({ block: "nearest" });
    if (focus) current.focus({ preventScroll: true });
  }
  return { element, draw, reveal };
}

function row(onclick) {
  const time = h("span", { class: "story-time" });
  const mark = h("span", { class: "story-mark", "aria-hidden": "true" });
  const body = h("span", { class: "story-body" });
  return h(
    "li",
    {},
    h("button", { type: "button", class: "story-one", onclick }, time, mark, body),
  );
}

function fill(node, past, step, isCurrent, t) {
  const button = node.firstElementChild;
  const [time, mark, body] = button.children;
  setAttribute(button, "aria-current", isCurrent ? "step" : null);
  setAttribute(button, "tabindex", isCurrent ? "0" : "-1");
  // Past events do not change, except for the end of an open interaction.
  const made = JSON.stringify([step.event, step.line]);
  if (button.dataset.made === made) return;
  button.dataset.made = made;
  const actor = actorOf(step.event);
  button.dataset.actor = actor;
  if (step.event.outcome) button.dataset.outcome = step.event.outcome;
  setText(time, t("history.since", { seconds: t.number(step.after_ms / 1_000, ONE_DIGIT) }));
  mark.replaceChildren(icon(DRAWINGS[actor], 18));
  body.replaceChildren(...happened(past, step, t));
}

/** @returns {Node[]} */
function happened(past, { event, line }, t) {
  const robot = line
    ? [h("span", { class: "story-line", "data-who": "robot" }, who("robot", t), line)]
    : [];
  if (event.type === "heard") return [...heard(event, t), ...robot];
  const { key, args } = eventWords(event, past);
  return [h("span", { class: "story-event", text: t(key, args) }), ...robot];
}

const who = (speaker, t) => h("b", { text: `${t(`history.who.${speaker}`)}: ` });

function heard(event, t) {
  const words = event.text || t("history.unheard");
  const said = h("span", { class: "story-line", "data-who": "person" }, who("person", t), words);
  const meanings = event.readings.map(({ text, weight }) => share(text, weight, t));
  const answers = event.answers.map(({ question, share: part }) => share(question, part, t));
  const chips = (label, all) =>
    all.length
      ? [h("span", { class: "story-shares" }, h("span", { text: `${label} ` }), ...all)]
      : [];
  return [
    said,
    ...chips(t("history.understood"), meanings),
    ...chips(t("history.answers"), answers),
  ];
}

function share(text, part, t) {
  return h(
    "span",
    { class: "story-share" },
    text,
    h("span", { class: "story-part", text: ` ${shareWords(part, t)}` }),
    " ",
  );
}
