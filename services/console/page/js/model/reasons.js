// @ts-check
/**
 * An action of the robot in the scene's names, as the server sends it.
 * @typedef {{type: "wait"|"not_here"|"say"} | {type: "pick"|"point", object: string}
 *   | {type: "attr", attribute: string, value: string} | {type: "which", attribute: string}
 *   | {type: "choice", attribute: string, values: string[]}} Action
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
  if (action.type === "choice") {
    const { attribute, values } = action;
    const options = values.map((value) => spokenValue({ attribute, value }, scene));
    return { key, args: { options: options.join(", ") } };
  }
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
 * @param {string|null} aim name of the object that is fetched
 * @returns {Action}
 */
export function decidedAction(dialogue, aim) {
  if (dialogue.decision === "ask" && dialogue.question) return dialogue.question;
  if (dialogue.decision === "pick" && aim) return { type: "pick", object: aim };
  return { type: dialogue.decision === "wait" ? "wait" : "say" };
}

/** Least loss of a whole bar, seconds: one that is shown as none has no bar. */
const BAR_MIN_S = 1;

/**
 * The decision and the best others, best first, each with its loss against the best.
 * @param {any} dialogue
 * @param {string|null} aim
 * @param {number} most
 * @returns {{action: Action, value: number, loss: number, length: number, chosen: boolean}[]} `loss` in
 *   seconds of the person's time; `length`: of its bar, a share of the longest or of one second
 */
export function ranked(dialogue, aim, most) {
  const chosen = { action: decidedAction(dialogue, aim), value: dialogue.value, chosen: true };
  const others = (dialogue.alternatives ?? []).map((other) => ({ ...other, chosen: false }));
  const all = [chosen, ...others].filter((one) => Number.isFinite(one.value));
  all.sort((a, b) => b.value - a.value || Number(b.chosen) - Number(a.chosen));
  const shown = all.slice(0, most);
  const top = shown[0]?.value ?? 0;
  const widest = Math.max(top - (shown.at(-1)?.value ?? 0), BAR_MIN_S);
  return shown.map((one) => {
    const loss = top - one.value;
    return { ...one, loss, length: loss / widest };
  });
}

/** Least probability of objects that an answer distinguishes. */
const LIKELY = 0.01;

/**
 * Information of an answer to the question, or certainty of a pick: a key of the strings with its figures.
 * @param {any} dialogue
 * @param {string|null} aim
 * @param {any} scene
 * @returns {{key: string, args: Record<string, any>}|null} null: nothing is known
 */
export function gist(dialogue, aim, scene) {
  const { decision, question, belief } = dialogue;
  const object = scene?.objects.find(({ name }) => name === aim);
  if (decision === "pick" && object && belief?.[object.name] !== undefined) {
    return { key: "why.sure", args: { object: object.label, p: belief[object.name] } };
  }
  if (decision !== "ask" || !question || !belief) return null;
  const likely = (scene?.objects ?? []).filter(({ name }) => belief[name] >= LIKELY);
  if (likely.length < 2) return null;
  const n = likely.length;
  if (question.type === "which" || question.type === "choice") {
    const values = likely.map(({ attributes }) => attributes?.[question.attribute]);
    const most = Math.max(...values.map((one) => values.filter((other) => other === one).length));
    return { key: "why.open", args: { most, all: n } };
  }
  const isMeant = ({ name, attributes }) =>
    question.type === "point"
      ? name === question.object
      : attributes?.[question.attribute] === question.value;
  const yes = likely.filter(isMeant).length;
  return { key: "why.split", args: { yes, no: n - yes, all: n } };
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
