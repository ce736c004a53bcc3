// @ts-check
import { calm, eachFrame, h, keyed, setAttribute, setText } from "../dom.js";
import { icon } from "../icons.js";
import { answers } from "../model/reasons.js";
import { whoControls } from "../model/turn.js";
import { attempt } from "./attempt.js";
import { press } from "./press.js";

/** A question shows without its voice after this time: there may be none. */
const VOICE_MS = 1_500;

/**
 * Shows the robot's question or sentence in large type, with one-press answers and corrections.
 * @param {HTMLElement} element
 * @param {{link: any, store: any, t: (key: string, args?: object) => string}} context
 */
export function mountQuestion(element, context) {
  const { link, store, t } = context;
  const kicker = h("p", { class: "question-kicker" });
  const words = h("p", { class: "question-words" });
  const quick = h("div", { class: "quick" });
  const notThat = correction("not_that", "undo");
  const startOver = correction("start_over", "again");
  const correct = h("div", { class: "correct" }, notThat, startOver);
  element.append(kicker, words, h("div", { class: "question-row" }, quick, correct));

  function correction(verb, drawing) {
    const correct = () => attempt(link.do(verb), context);
    return h(
      "button",
      { type: "button", class: "small", id: verb, onclick: correct },
      icon(drawing, 17),
      t(`act.${verb}`),
    );
  }
  const answer = (item) => {
    const say = () => press(item.text, context);
    const words = item.key ? t(item.key) : item.text;
    return h("button", { type: "button", class: "answer", onclick: say, text: words });
  };

  let prompt = null;
  let timer = 0;
  const draw = eachFrame(() => {
    const dialogue = store.get("dialogue");
    const scene = store.get("scene");
    const now = present(dialogue, scene, t);
    const fresh = words.textContent !== now.words;
    setText(kicker, now.kicker);
    setText(words, now.words);
    setAttribute(element, "data-kind", now.kind);
    const mine = whoControls(store.get("control"), store.get("welcome")) === "mine";
    keyed(quick, mine ? answers(dialogue, scene) : [], (item) => item.text, answer);
    const open = mine && dialogue?.interaction > 0;
    correct.hidden = !mine;
    notThat.disabled = startOver.disabled = !open;
    if (fresh && dialogue?.prompt !== prompt) awaitVoice(dialogue?.prompt ?? null);
    const heard = store.get("speaking")?.prompt === dialogue?.prompt;
    if (heard) reveal();
  });

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

  store.subscribe(["dialogue", "scene", "speaking", "control", "welcome"], draw);
  draw();
}

/**
 * @param {any} dialogue
 * @param {any} scene
 * @param {(key: string, args?: object) => string} t
 */
function present(dialogue, scene, t) {
  const noun = scene?.noun ?? "";
  if (!dialogue || !scene) return { kind: "none", kicker: "", words: t("question.none") };
  if (dialogue.interaction === 0) {
    const last = dialogue.last;
    const label = scene.objects.find((one) => one.name === last?.object)?.label ?? last?.object;
    const args = { object: label ?? "", n: last?.questions ?? 0, seconds: last?.seconds ?? 0 };
    const kicker = last ? t(`last.${last.outcome}`, args) : t("question.idle.kicker");
    return { kind: "idle", kicker, words: t("question.idle", { noun }) };
  }
  const kind = ["ask", "pick", "wait", "say", "cancel"].includes(dialogue.decision)
    ? dialogue.decision
    : "say";
  const words = dialogue.text || t(`question.${kind}.words`);
  return { kind, kicker: t(`question.${kind}`), words };
}
