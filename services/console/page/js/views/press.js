// @ts-check
import { objectWords, speak } from "../speak.js";
import { attempt } from "./attempt.js";

/**
 * Says words at a press; if that fails, shows why.
 * @param {string} text
 * @param {{link: any, store: any, t: (key: string, args?: object) => string}} context
 */
export function press(text, context) {
  return attempt(speak(text, context), context);
}

/**
 * Says an object at a press on it, in the list or in the picture.
 * @param {{description: string}} object of the section `scene`
 * @param {{link: any, store: any, t: (key: string, args?: object) => string}} context
 */
export function pressObject(object, context) {
  return press(objectWords(object), context);
}
