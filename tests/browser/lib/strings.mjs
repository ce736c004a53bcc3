// The page's words, so that tests name what a person reads without repeating it.

import { readFileSync } from "node:fs";
import { join } from "node:path";
import { ROOT } from "./program.mjs";

const english = JSON.parse(
  readFileSync(join(ROOT, "services/console/page/strings/en.json"), "utf8"),
);

/**
 * The English text of a key with its places filled.
 * @param {string} key
 * @param {Record<string, string | number>} args
 */
export function t(key, args = {}) {
  if (!(key in english)) throw new Error(`strings/en.json has no ${key}`);
  return english[key].replace(/\{(\w+)\}/g, (_, name) => String(args[name]));
}
