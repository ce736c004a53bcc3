// Waiting for facts.

import { setTimeout as sleep } from "node:timers/promises";

const EVERY_MS = 50;
const PATIENCE_MS = 30_000;

/**
 * Waits until `look` gives something true, and returns it.
 * @template T
 * @param {string} what is waited for, for the message of a failure
 * @param {() => T | Promise<T>} look
 */
export async function until(what, look, patienceMs = PATIENCE_MS) {
  const end = Date.now() + patienceMs;
  for (;;) {
    const found = await look();
    if (found) return found;
    if (Date.now() > end) throw new Error(`waited ${patienceMs / 1000} s for ${what}`);
    await sleep(EVERY_MS);
  }
}
