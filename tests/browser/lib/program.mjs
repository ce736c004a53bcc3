// The programs under test.

import { execFile } from "node:child_process";
import { existsSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { promisify } from "node:util";

/** The repository. */
export const ROOT = resolve(dirname(fileURLToPath(import.meta.url)), "../../..");
/** Where cargo builds. */
export const TARGET = process.env.CARGO_TARGET_DIR ?? join(ROOT, "target");

const run = promisify(execFile);
const CALL_MS = 60_000;

/** @param {string} name of a program that this repository builds */
export function program(name) {
  const path = join(TARGET, process.env.WHICHONE_BUILD ?? "debug", name);
  if (!existsSync(path)) throw new Error(`${path} is missing; build it: cargo build --workspace`);
  return path;
}

/**
 * Runs `whichone` to its end. Never fails for an exit code: the caller looks at it.
 * @param {string[]} words
 * @param {Record<string, string>} env
 * @returns {Promise<{code: number, stdout: string, stderr: string}>}
 */
export async function whichone(words, env) {
  const options = { env: { ...process.env, ...env }, timeout: CALL_MS, maxBuffer: 1 << 26 };
  try {
    return { code: 0, ...(await run(program("whichone"), words, options)) };
  } catch (error) {
    if (typeof error.code !== "number") throw error;
    return { code: error.code, stdout: error.stdout, stderr: error.stderr };
  }
}
