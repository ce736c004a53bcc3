// @ts-check
/**
 * @typedef {object} Step
 * @property {number} after_ms since the interaction began
 * @property {{seq: number, text: string}[]} heard
 * @property {number[]} belief in the order of the interaction's objects
 * @property {number} absent
 * @property {string} decision
 * @property {string} text the robot's line
 *
 * @typedef {object} Past
 * @property {number} interaction
 * @property {number} unix_ms
 * @property {string[]} objects short descriptions
 * @property {Step[]} steps
 * @property {{outcome: string, object: string|null, questions: number, seconds: number}|null} end
 *
 * @typedef {object} Place in the history
 * @property {number} interaction 0: nowhere
 * @property {number} step from 0; the end is one beyond the last
 */

/** Nowhere: before anything was chosen. @type {Place} */
export const NOWHERE = { interaction: 0, step: 0 };

/** Number of places in an interaction: its steps, and its end. @param {Past} past */
export const placesIn = (past) => past.steps.length + (past.end ? 1 : 0);

/**
 * A place that exists: the nearest to the one that was, or the beginning of the newest interaction.
 * @param {Past[]} history oldest first
 * @param {Place} at
 * @returns {Place}
 */
export function settle(history, at) {
  const past = history.find(({ interaction }) => interaction === at.interaction);
  if (past) return { ...at, step: Math.max(0, Math.min(at.step, placesIn(past) - 1)) };
  const newest = history.at(-1);
  return newest ? { interaction: newest.interaction, step: 0 } : NOWHERE;
}

/**
 * Goes forwards or backwards by one step, over the borders of interactions.
 * @param {Past[]} history
 * @param {Place} at
 * @param {1|-1} by
 * @returns {Place} the same where there is none
 */
export function step(history, at, by) {
  const n = history.findIndex(({ interaction }) => interaction === at.interaction);
  if (n < 0) return settle(history, at);
  const next = at.step + by;
  if (next >= 0 && next < placesIn(history[n])) return { ...at, step: next };
  const other = history[n + by];
  if (!other || placesIn(other) === 0) return at;
  return { interaction: other.interaction, step: by > 0 ? 0 : placesIn(other) - 1 };
}

/**
 * Goes to the beginning of the next or the previous interaction.
 * @param {Past[]} history
 * @param {Place} at
 * @param {1|-1} by
 * @returns {Place}
 */
export function leap(history, at, by) {
  const n = history.findIndex(({ interaction }) => interaction === at.interaction);
  const other = history[n + by];
  return n >= 0 && other ? { interaction: other.interaction, step: 0 } : settle(history, at);
}

/** What each key does. @type {Record<string, (history: Past[], at: Place) => Place>} */
export const KEYS = {
  ArrowLeft: (history, at) => step(history, at, -1),
  ArrowRight: (history, at) => step(history, at, 1),
  ArrowUp: (history, at) => leap(history, at, 1),
  ArrowDown: (history, at) => leap(history, at, -1),
  Home: (_, at) => ({ ...at, step: 0 }),
  End: (history, at) => settle(history, { ...at, step: Number.MAX_SAFE_INTEGER }),
};

/**
 * What is shown of a place.
 * @param {Past[]} history
 * @param {Place} at
 * @returns {{past: Past, step: Step|null, isEnd: boolean, before: number[]|null}|null} `step`: at the
 *   end that of the last decision; `before`: the belief one step earlier
 */
export function shownAt(history, at) {
  const past = history.find(({ interaction }) => interaction === at.interaction);
  if (!past) return null;
  const isEnd = at.step >= past.steps.length;
  const k = Math.min(at.step, past.steps.length - 1);
  return { past, step: past.steps[k] ?? null, isEnd, before: past.steps[k - 1]?.belief ?? null };
}
