// @ts-check
import { h, setAttribute, setText } from "../dom.js";
import { icon } from "../icons.js";
import { shareWords } from "../model/ranking.js";
import { dayOf, effortOf, timeOf } from "./list.js";
import { mindView } from "./mind.js";
import { endWords, eventWords, move, stepsOf } from "./model.js";
import { storyView } from "./story.js";

/** Moves by keys: to which place from which. @type {Record<string, (count: number, at: number) => number>} */
const KEYS = {
  ArrowLeft: (count, at) => move(count, at, -1),
  ArrowRight: (count, at) => move(count, at, 1),
  Home: () => 0,
  End: (count) => count - 1,
};

/**
 * One interaction: events, step by step, and the robot's belief.
 * @param {any} t
 * @param {Node[]} tools buttons next to its title
 * @param {"h2"|"h3"} level of its title
 */
export function oneView(t, tools, level) {
  const title = h(level, { class: "past-title" });
  const about = h("p", { class: "past-about" });
  const note = h("p", { class: "past-note" });
  const story = storyView(t, (step) => go(step));
  const mind = mindView(t);
  const spoken = h("p", { class: "hidden", role: "status" });
  const place = h("span", { class: "past-place" });
  const turn = (by) => () => go(move(steps.length, at, by));
  const back = h(
    "button",
    { type: "button", class: "small", onclick: turn(-1) },
    icon("before", 18),
    t("history.before"),
  );
  const on = h(
    "button",
    { type: "button", class: "small", onclick: turn(1) },
    t("history.after"),
    icon("after", 18),
  );
  const head = h(
    "header",
    { class: "past-head" },
    h("div", { class: "past-heading" }, title, about),
    h("div", { class: "past-tools" }, ...tools),
  );
  const walk = h("div", { class: "past-walk" }, back, place, on);
  const told = h("div", { class: "past-told" }, story.element, walk);
  const body = h("div", { class: "past-body" }, told, mind.element);
  const element = h("article", { class: "past-detail", hidden: true }, head, note, body, spoken);

  /** @type {import("./model.js").Interaction|null} */
  let past = null;
  /** @type {import("./model.js").Step[]} */
  let steps = [];
  let at = 0;

  function go(step, focus = false) {
    if (!past || steps.length === 0) return;
    at = move(steps.length, step, 0);
    story.draw(past, steps, at);
    story.reveal(focus);
    mind.draw(past, steps[at]);
    setText(place, t("history.place", { k: at + 1, of: steps.length }));
    setText(spoken, spokenWords(past, steps[at], at, steps.length, t));
    // Not `disabled`: the focus stays on them, and with it the keys.
    setAttribute(back, "aria-disabled", at === 0 ? "true" : null);
    setAttribute(on, "aria-disabled", at === steps.length - 1 ? "true" : null);
  }

  /**
   * Shows an interaction; one that is shown already stays unchanged.
   * @param {import("./model.js").Interaction|null} shown
   */
  function show(shown) {
    const isSame = shown !== null && shown.interaction === past?.interaction;
    past = shown;
    element.hidden = shown === null;
    if (!shown) return;
    steps = stepsOf(shown);
    const { key, args } = endWords(shown.end);
    setText(title, t(key, args));
    setText(about, aboutWords(shown, t));
    setText(note, noteWords(shown, t));
    note.hidden = note.textContent === "";
    go(isSame ? at : 0);
  }
  /** Handles a key; true if the view moved. */
  function onKey(event, focus) {
    const to = KEYS[event.key];
    if (!past || !to) return false;
    go(to(steps.length, at), focus);
    return true;
  }
  const shown = () => past;
  const focus = () => story.reveal(true);
  return { element, show, shown, onKey, focus };
}

function aboutWords({ unix_ms, end, interaction }, t) {
  const day = unix_ms === null ? "" : `${dayOf(unix_ms, t)}, ${timeOf(unix_ms, t)}`;
  return [t("history.number", { n: interaction }), day, effortOf(end, t)]
    .filter(Boolean)
    .join(" · ");
}

function noteWords({ whole, left_out }, t) {
  const lost = whole ? "" : t("history.partial");
  const left = left_out > 0 ? t("history.left_out", { n: left_out }) : "";
  return [lost, left].filter(Boolean).join(" ");
}

function spokenWords(past, { event, line, thought }, at, of, t) {
  const { key, args } = eventWords(event, past);
  const what = event.type === "heard" ? `${t("history.who.person")}: ${event.text}` : t(key, args);
  const robot = line ? `${t("history.who.robot")}: ${line}` : "";
  const best = bestOf(past, thought, t);
  return [t("history.place", { k: at + 1, of }), what, robot, best].filter(Boolean).join(". ");
}

function bestOf({ objects }, thought, t) {
  if (!thought?.belief.length) return "";
  const n = thought.belief.indexOf(Math.max(...thought.belief));
  return t("history.likeliest", {
    object: objects[n].label,
    share: shareWords(thought.belief[n], t),
  });
}
