// @ts-check
import { calm, eachFrame, h, keyed, setAttribute, setText } from "../dom.js";
import { icon } from "../icons.js";
import { offers } from "../model/answers.js";
import { drawingOf } from "../model/drawing.js";
import { serviceWords } from "../model/health.js";
import { attempt } from "./attempt.js";
import { drawObject } from "./drawing.js";
import { press } from "./press.js";

/** A question shows without its voice after this time: there may be none. */
const VOICE_MS = 1_500;

/** Words of more characters than these are set smaller: answers and objects need room, too. */
const LONG = 48;

/**
 * Shows in large type the robot's question or sentence, or what it has handed over, with what can be
 * said to it at a press, and corrections.
 * @param {HTMLElement} element
 * @param {{link: any, store: any, t: any}} context
 */
export function mountQuestion(element, context) {
  const { link, store, t } = context;
  const kicker = h("p", { class: "question-kicker" });
  const words = h("p", { class: "question-words" });
  const more = h("p", { class: "question-more" });
  const drawn = h("div", { class: "question-drawing", hidden: true });
  const quick = h("div", { class: "quick" });
  const notThat = correction("not_that", "undo");
  const startOver = correction("start_over", "again");
  const correct = h("div", { class: "correct" }, notThat, startOver);
  const said = h("div", { class: "question-said" }, kicker, words, more);
  const row = h("div", { class: "question-row" }, quick, correct);
  element.append(h("div", { class: "question-head" }, drawn, said), row);

  function correction(verb, drawing) {
    const take = () => attempt(link.do(verb), context);
    return h(
      "button",
      { type: "button", class: "small", id: verb, onclick: take },
      icon(drawing, 17),
      t(`act.${verb}`),
    );
  }
  const makeOffer = ({ text, key, kind }) => {
    const say = () => {
      press(text, context);
      if (key === "delivery.right") store.set("settled", store.get("delivery")?.interaction);
    };
    const shown = key
      ? { text: t(key) }
      : { text: kind === "example" ? `“${text}”` : text, lang: "en" };
    return h("button", {
      type: "button",
      class: "answer",
      "data-kind": kind,
      onclick: say,
      ...shown,
    });
  };

  let prompt = null;
  let timer = 0;
  let pictured = null;
  const draw = eachFrame(() => {
    const dialogue = store.get("dialogue");
    const scene = store.get("scene");
    const delivery = store.get("delivery") ?? null;
    const state = store.get("now");
    const now = present(state, dialogue, scene, delivery, t);
    const fresh = words.textContent !== now.words;
    setText(kicker, now.kicker);
    setText(words, now.words);
    setText(more, now.more ?? "");
    setAttribute(more, "lang", now.moreLang ?? null);
    setAttribute(words, "lang", now.lang ?? null);
    setAttribute(words, "data-length", now.words.length > LONG ? "long" : null);
    setAttribute(element, "data-kind", now.kind);
    picture(now.kind === "delivered" ? delivery.object : null, scene);
    const mine = state.who === "mine" && state.is !== "held";
    const all = mine ? offers(dialogue, scene, delivery) : [];
    // A robot that is stopped is not invited to fetch.
    const offered = state.is === "stopped" ? all.filter(({ kind }) => kind !== "example") : all;
    keyed(quick, offered, ({ text, kind }) => `${kind} ${text}`, makeOffer);
    correct.hidden = !mine || !(dialogue?.interaction > 0);
    // A question has "no" next to it already.
    notThat.hidden = offered.some(({ text }) => text === "no");
    if (fresh && dialogue?.prompt !== prompt) awaitVoice(dialogue?.prompt ?? null);
    const heard = store.get("speaking")?.prompt === dialogue?.prompt;
    if (heard) reveal();
  });

  function picture(object, scene) {
    if (object === pictured) return;
    pictured = object;
    drawn.hidden = object === null;
    drawn.replaceChildren(...(object ? [drawObject(drawingOf(object, scene.noun))] : []));
  }
  function awaitVoice(next) {
    prompt = next;
    clearTimeout(timer);
    const speaking = store.get("speaking");
    if (!next || !element.dataset.seen || speaking?.prompt === next) return reveal();
    words.classList.add("awaits");
    timer = setTimeout(reveal, VOICE_MS);
  }
  function reveal() {
    clearTimeout(timer);
    element.dataset.seen = "";
    if (!words.classList.contains("awaits")) return;
    words.classList.remove("awaits");
    if (calm()) return;
    const from = { opacity: 0.2, transform: "translateY(6px)" };
    words.animate([from, { opacity: 1, transform: "none" }], { duration: 350, easing: "ease-out" });
  }

  store.subscribe(["dialogue", "scene", "delivery", "speaking", "now"], draw);
}

/**
 * @typedef {object} Headline
 * @property {string} kind
 * @property {string} kicker
 * @property {string} words
 * @property {string} [more] a second line
 * @property {string} [lang] of words that are not the page's own
 * @property {string} [moreLang] of the second line
 */

/**
 * Text in large type.
 * @param {import("../now.js").Now} now
 * @param {any} dialogue
 * @param {any} scene
 * @param {import("../delivery.js").Delivery|null} delivery
 * @param {any} t
 * @returns {Headline}
 */
function present(now, dialogue, scene, delivery, t) {
  if (now.why && now.why !== "connecting") {
    const kicker = t("question.disconnected");
    return { kind: "disconnected", kicker, words: t(`turn.${now.why}`) };
  }
  if (!dialogue || !scene) return { kind: "none", kicker: "", words: t("question.none") };
  if (now.is === "stopped") return stopped(now, dialogue, scene, t);
  if (now.is === "held") {
    return { kind: "held", kicker: t("question.held"), words: serviceWords(now, t) };
  }
  if (delivery) {
    const { label } = delivery.object;
    const words = label.charAt(0).toUpperCase() + label.slice(1);
    return { kind: "delivered", kicker: t("delivery.kicker"), words, lang: "en" };
  }
  if (dialogue.interaction === 0 && !now.question) {
    const kicker = t("question.idle.kicker");
    return { kind: "idle", kicker, words: t("question.idle", { noun: scene.noun }) };
  }
  const kind = ["ask", "pick", "wait", "say", "cancel"].includes(dialogue.decision)
    ? dialogue.decision
    : "say";
  const own = dialogue.text ? { words: dialogue.text, lang: "en" } : {};
  return { kind, kicker: t(`question.${kind}`), words: t(`question.${kind}.words`), ...own };
}

/** A stop comes first; the pending question, or its successor, is below it. @returns {Headline} */
function stopped(now, dialogue, scene, t) {
  const key = now.atRest ? "turn.stopped" : "turn.stopping";
  const head = { kind: "stopped", kicker: "", words: t(key), more: t(`${key}.more`) };
  if (now.question && dialogue.text) return { ...head, more: dialogue.text, moreLang: "en" };
  const object = scene.objects.find(({ name }) => name === now.aim)?.label;
  return object ? { ...head, more: t("question.stopped.aim", { object }) } : head;
}
