// @ts-check
import { banner } from "../model/turn.js";

/** Signs that outrank the robot's words: nothing else is true while they hold. */
const OUTRANKING = ["connecting", "offline", "replaced", "gave_way", "stopped", "down"];
/** Outcomes that the page has words for. */
const OUTCOMES = "delivered refused failed cancelled abandoned scene_changed not_here".split(" ");

/**
 * The sentence that the audience reads: the robot's question or announcement, else what is the matter.
 * @param {{link: any, turn: any, arm: any, dialogue: any, scene: any}} now
 * @param {(key: string, args?: object) => string} t
 * @returns {string}
 */
export function sentence({ link, turn, arm, dialogue, scene }, t) {
  const { key } = banner(link, turn, arm);
  if (OUTRANKING.includes(key)) return t(`turn.${key}`);
  if (!dialogue || !scene) return t("question.none");
  if (dialogue.interaction > 0) return dialogue.text || t("question.say.words");
  const { last } = dialogue;
  if (!last || !OUTCOMES.includes(last.outcome)) return t("question.idle", { noun: scene.noun });
  const object = scene.objects.find(({ name }) => name === last.object)?.label ?? last.object;
  return t(`history.${last.outcome}`, { object: object ?? "" });
}

/**
 * Size of a sentence, percent of the picture's height: the longer, the smaller, and never below what is
 * read at five metres.
 * @param {string} text
 */
export function sizeOf(text) {
  if (text.length <= 28) return 11;
  if (text.length <= 60) return 8.5;
  return text.length <= 110 ? 6.8 : 5.4;
}

/**
 * The latest words that were meant for the robot.
 * @param {{who: string, text: string}[]|undefined} lines
 */
export const lastHeard = (lines) => lines?.findLast(({ who }) => who === "person")?.text ?? "";
