// @ts-check
/**
 * An action of the robot, as the page shows it.
 * @typedef {{kind: "ask"|"pick"|"wait"|"absent"|"other", text: string}} Action
 */

/**
 * Reads an action's text. Objects are called by their labels.
 * @param {string} text e.g. `ask: Is it white?`, `pick white2`, `wait`
 * @param {{objects: {name: string, label: string}[]}|undefined} scene
 * @returns {Action}
 */
export function readAction(text, scene) {
  const ask = /^ask:\s*(.+)$/s.exec(text);
  if (ask) return { kind: "ask", text: ask[1] };
  const pick = /^pick\s+(.+)$/s.exec(text);
  if (pick) {
    const object = scene?.objects.find((one) => one.name === pick[1]);
    return { kind: "pick", text: object?.label ?? pick[1] };
  }
  if (text === "wait") return { kind: "wait", text: "" };
  if (text.startsWith("conclude")) return { kind: "absent", text: "" };
  return { kind: "other", text };
}

/**
 * What was decided, as an action.
 * @param {any} dialogue
 * @param {any} scene
 * @param {string|null|undefined} aim name of the object that the arm is after
 * @returns {Action}
 */
export function decidedAction(dialogue, scene, aim) {
  const about = dialogue.question_about?.text || dialogue.text;
  if (dialogue.decision === "ask") return { kind: "ask", text: about };
  if (dialogue.decision === "pick") {
    const name = aim ?? likeliest(dialogue.belief, scene);
    return readAction(`pick ${name}`, scene);
  }
  if (dialogue.decision === "wait") return { kind: "wait", text: "" };
  return { kind: "other", text: dialogue.text };
}

function likeliest(belief, scene) {
  const best = belief.reduce((top, p, i) => (p > belief[top] ? i : top), 0);
  return scene?.objects[best]?.name ?? "";
}

/**
 * Shortest bar, as a share of the longest: the worst action still shows as one.
 */
const SHORTEST = 0.04;

/**
 * The decision and the best others, best first, with the lengths of their bars.
 * @param {any} dialogue
 * @param {any} scene
 * @param {string|null} [aim]
 * @returns {{action: Action, value: number, length: number, chosen: boolean}[]}
 */
export function ranked(dialogue, scene, aim) {
  const chosen = {
    action: decidedAction(dialogue, scene, aim),
    value: dialogue.value,
    chosen: true,
  };
  const others = (dialogue.alternatives ?? []).map(({ action, value }) => ({
    action: readAction(action, scene),
    value,
    chosen: false,
  }));
  const all = [chosen, ...others].filter((one) => Number.isFinite(one.value));
  all.sort((a, b) => b.value - a.value || Number(b.chosen) - Number(a.chosen));
  const top = Math.max(...all.map((one) => one.value));
  const low = Math.min(...all.map((one) => one.value), 0);
  const span = top - low;
  const length = (value) => (span > 0 ? SHORTEST + (1 - SHORTEST) * ((value - low) / span) : 1);
  return all.map((one) => ({ ...one, length: length(one.value) }));
}

/** Bounds nearer than this are one figure to people. */
const NEAR = 0.05;

/**
 * What the bounds prove, as a key of the strings with its figures.
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
 * How many questions are still to come, as a key with its figure.
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
 * Answers that can be given with one press.
 * @param {any} dialogue
 * @param {any} scene
 * @returns {{key: string|null, text: string}[]} `text` is what is said; `key` a string to show for it
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
