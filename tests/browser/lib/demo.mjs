// The demo as it was built, and a person who wants one of its bowls.

import { existsSync } from "node:fs";
import { join } from "node:path";
import { ROOT } from "./program.mjs";

/** The folder of the built demo. */
export const DEMO = join(ROOT, "target/docs/demo");
/** Why its tests do not run, or null. */
export const MISSING = existsSync(join(DEMO, "whichone.wasm"))
  ? null
  : "the demo is not built; help: scripts/docs demo";

/** What is true of the small white bowl on the counter. */
const WANTED = ["white", "plastic", "small", "round", "on the counter"];

/**
 * Answers the question in words.
 * @param {string} question
 */
export function truth(question) {
  const words = question.toLowerCase();
  const values = ["white", "metallic", "clear", "plastic", "metal", "small", "big", "round"].concat(
    ["in the dishwasher", "on the counter", "in the cabinet"],
  );
  const named = values.filter((value) => new RegExp(`\\b${value}\\b`).test(words));
  const own = named.filter((value) => WANTED.includes(value));
  if (named.length > 1) return own[0] ?? "none of them";
  return own.length > 0 ? "yes" : "no";
}
