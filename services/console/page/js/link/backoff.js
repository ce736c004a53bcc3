// @ts-check
/** The first wait before connecting again, milliseconds. */
const LEAST_MS = 250;
/** The longest wait, milliseconds. */
const MOST_MS = 5_000;

/**
 * Delay before reconnecting: doubles each time, with jitter so that two pages do not stay in step.
 * @param {number} attempt attempts that have failed in a row, from 1
 * @param {number} random in [0, 1)
 * @returns {number} milliseconds
 */
export function backoffMs(attempt, random) {
  const wait = Math.min(MOST_MS, LEAST_MS * 2 ** Math.min(10, Math.max(0, attempt - 1)));
  return Math.max(LEAST_MS, wait * (0.75 + 0.25 * random));
}
