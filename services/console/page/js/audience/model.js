// @ts-check
import { banner } from "../model/turn.js";

/** States that outrank the robot's words: nothing else is true while they hold. */
const OUTRANKING = ["disconnected", "stopped", "held"];

/**
 * The sentence that the audience reads: the robot's question or announcement, else the problem.
 * @param {{now: import("../now.js").Now, dialogue: any, scene: any, delivery: any}} shown
 * @param {(key: string, args?: object) => string} t
 * @returns {string}
 */
export function sentence({ now, dialogue, scene, delivery }, t) {
  if (OUTRANKING.includes(now.is)) return t(`turn.${banner(now).key}`);
  if (!dialogue || !scene) return t("question.none");
  if (dialogue.interaction > 0) return dialogue.text || t("question.say.words");
  if (delivery) return t("history.delivered", { object: delivery.object.label });
  return t("question.idle", { noun: scene.noun });
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
