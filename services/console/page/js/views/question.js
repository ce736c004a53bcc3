// @ts-check
import { calm, eachFrame, h, keyed, setAttribute, setText } from "../dom.js";
import { icon } from "../icons.js";
import { offers } from "../model/answers.js";
import { drawingOf } from "../model/drawing.js";
import { endWords } from "../model/notes.js";
import { whoControls } from "../model/turn.js";
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
  const drawn = h("div", { class: "question-drawing", hidden: true });
  const quick = h("div", { class: "quick" });
  const notThat = correction("not_that", "undo");
  const startOver = correction("start_over", "again");
  const correct = h("div", { class: "correct" }, notThat, startOver);
  const said = h("div", { class: "question-said" }, kicker, words);
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
    const now = present(dialogue, scene, delivery, t);
    const fresh = words.textContent !== now.words;
    setText(kicker, now.kicker);
    setText(words, now.words);
    setAttribute(words, "lang", now.lang ?? null);
    setAttribute(words, "data-length", now.words.length > LONG ? "long" : null);
    setAttribute(element, "data-kind", now.kind);
    picture(delivery?.object ?? null, scene);
    const mine = whoControls(store.get("control"), store.get("welcome")) === "mine";
    const offered = mine ? offers(dialogue, scene, delivery) : [];
    keyed(quick, offered, ({ text, kind }) => `${kind} ${text}`, makeOffer);
    correct.hidden = !mine || !(dialogue?.interaction > 0);
    // To a question "no" is beside it already.
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

  const sections = ["dialogue", "scene", "delivery", "speaking", "control", "welcome"];
  store.subscribe(sections, draw);
  draw();
}

/**
 * @param {any} dialogue
 * @param {any} scene
 * @param {import("../delivery.js").Delivery|null} delivery
 * @param {any} t
 * @returns {{kind: string, kicker: string, words: string, lang?: string}} `lang`: of words that are not
 *   the page's own
 */
function present(dialogue, scene, delivery, t) {
  if (!dialogue || !scene) return { kind: "none", kicker: "", words: t("question.none") };
  const end = dialogue.last;
  if (delivery) {
    const { label } = delivery.object;
    const words = label.charAt(0).toUpperCase() + label.slice(1);
    return { kind: "delivered", kicker: t("delivery.kicker"), words, lang: "en" };
  }
  if (dialogue.interaction === 0 && !waits(dialogue)) {
    const label = scene.objects.find((one) => one.name === end?.object)?.label ?? end?.object;
    const kicker = end ? endWords({ ...end, object: label }, t) : t("question.idle.kicker");
    return { kind: "idle", kicker, words: t("question.idle", { noun: scene.noun }) };
  }
  const kind = ["ask", "pick", "wait", "say", "cancel"].includes(dialogue.decision)
    ? dialogue.decision
    : "say";
  const own = dialogue.text ? { words: dialogue.text, lang: "en" } : {};
  return { kind, kicker: t(`question.${kind}`), words: t(`question.${kind}.words`), ...own };
}

/** Returns whether a question stands although no request is open. */
function waits({ question }) {
  return question !== null && question !== undefined && question.type !== "none";
}
