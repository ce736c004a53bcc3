// @ts-check
/**
 * An action of the robot in the scene's names, as the server sends it.
 * @typedef {{type: "wait"|"not_here"|"say"} | {type: "pick"|"point", object: string}
 *   | {type: "attr", attribute: string, value: string} | {type: "which", attribute: string}} Action
 */

/**
 * Words for an action: a key of the strings with its arguments, objects by their labels and values as
 * they are spoken.
 * @param {any} action
 * @param {any} scene
 * @returns {{key: string, args: Record<string, string>}}
 */
export function actionWords(action, scene) {
  const key = `action.${action.type}`;
  if (action.type === "pick" || action.type === "point") {
    const object = scene?.objects.find(({ name }) => name === action.object);
    return { key, args: { object: object?.label ?? action.object } };
  }
  if (action.type === "attr") return { key, args: { value: spokenValue(action, scene) } };
  if (action.type === "which") return { key, args: { attribute: action.attribute } };
  return { key, args: {} };
}

function spokenValue({ attribute, value }, scene) {
  const known = scene?.attributes.find(({ name }) => name === attribute);
  return known?.values.find(({ name }) => name === value)?.spoken ?? value;
}

/**
 * The decision in force as an action.
 * @param {any} dialogue
 * @param {string|null|undefined} aim name of the object that the arm fetches
 * @returns {Action}
 */
export function decidedAction(dialogue, aim) {
  if (dialogue.decision === "ask" && dialogue.question) return dialogue.question;
  if (dialogue.decision === "pick") {
    return { type: "pick", object: aim ?? mostLikely(dialogue.belief) };
  }
  return { type: dialogue.decision === "wait" ? "wait" : "say" };
}

function mostLikely(belief) {
  const [first = ["", 0], ...others] = Object.entries(belief ?? {});
  return others.reduce((best, one) => (one[1] > best[1] ? one : best), first)[0];
}

/** Shortest bar, as a share of the longest: the worst action has a visible one. */
const SHORTEST = 0.04;

/**
 * The decision and the best others, best first, with the lengths of their bars.
 * @param {any} dialogue
 * @param {string|null} [aim]
 * @returns {{action: Action, value: number, length: number, chosen: boolean}[]}
 */
export function ranked(dialogue, aim) {
  const chosen = { action: decidedAction(dialogue, aim), value: dialogue.value, chosen: true };
  const others = (dialogue.alternatives ?? []).map((other) => ({ ...other, chosen: false }));
  const all = [chosen, ...others].filter((one) => Number.isFinite(one.value));
  all.sort((a, b) => b.value - a.value || Number(b.chosen) - Number(a.chosen));
  const top = Math.max(...all.map((one) => one.value));
  const low = Math.min(...all.map((one) => one.value), 0);
  const span = top - low;
  const length = (value) => (span > 0 ? SHORTEST + (1 - SHORTEST) * ((value - low) / span) : 1);
  return all.map((one) => ({ ...one, length: length(one.value) }));
}

/** Bounds closer than this are shown as one figure. */
const NEAR = 0.05;

/**
 * The statement that the bounds prove: a key of the strings with its figures.
 * @param {number} value
 * @param {[number, number]|null|undefined} bounds
 * @returns {{key: string, args: Record<string, number>}|null}
 */
export function proof(value, bounds) {
  if (!bounds) return null;
  const [low, high] = bounds;
  if (high - low <= NEAR) return { key: "why.proven", args: { value: round(high) } };
  if (high - value <= NEAR) return { key: "why.proven", args: { value: round(high) } };
  return { key: "why.bounded", args: { low: round(low), high: round(high) } };
}

/**
 * The expected number of further questions: a key of the strings with its figure.
 * @param {number} expected
 * @returns {{key: string, args: Record<string, number>}}
 */
export function toCome(expected) {
  if (!(expected > 0.05)) return { key: "why.none", args: {} };
  const figure = Math.round(expected * 10) / 10;
  return { key: "why.expected", args: { n: figure } };
}

function round(value) {
  return Math.round(value * 10) / 10;
}

/**
 * Answers that can be given with one click.
 * @param {any} dialogue
 * @param {any} scene
 * @returns {{key: string|null, text: string}[]} `text` is submitted; `key` is the string to show for it
 */
export function answers(dialogue, scene) {
  const question = dialogue?.question;
  if (dialogue?.decision !== "ask" || !question) return [];
  if (question.type === "attr" || question.type === "point") {
    return [
      { key: "answer.yes", text: "yes" },
      { key: "answer.no", text: "no" },
    ];
  }
  if (question.type !== "which") return [];
  const attribute = scene?.attributes.find((one) => one.name === question.attribute);
  return (attribute?.values ?? []).slice(0, 8).map((value) => ({ key: null, text: value.spoken }));
}
