// @ts-check
import { unlistedOf } from "./ranking.js";

/**
 * Words that can be said with one press.
 * @typedef {object} Offer
 * @property {string} text words
 * @property {string|null} key the string to show for it; null: the words themselves
 * @property {"main"|"value"|"aside"|"example"} kind
 */

/** @param {string} text @param {Offer["kind"]} kind @param {string|null} [key] @returns {Offer} */
const offer = (text, kind, key = null) => ({ text, key, kind });

const YES_NO = [offer("yes", "main", "answer.yes"), offer("no", "main", "answer.no")];
const ASIDES = [
  offer("I don't know", "aside", "answer.unknown"),
  offer("it doesn't matter", "aside", "answer.any"),
];
/** After a hand-over, in the words that a person would type. */
const AFTER_DELIVERY = [
  offer("yes, that's right", "main", "delivery.right"),
  offer("no, that's the wrong one", "main", "delivery.wrong"),
  offer("put it back", "aside", "delivery.back"),
];

/** Most values that are offered. */
const VALUES_MAX = 8;
/** Below this probability an object's values are not offered. */
const UNLIKELY = 0.005;

/**
 * Answers to the robot's question.
 * @param {any} dialogue
 * @param {any} scene
 * @returns {Offer[]}
 */
export function answers(dialogue, scene) {
  const question = dialogue?.question;
  if (!question || dialogue.decision === "pick" || dialogue.decision === "cancel") return [];
  if (question.type === "point") {
    // A pick that waits for a yes is not a question about the object.
    return dialogue.decision === "ask" ? [...YES_NO, ...ASIDES] : YES_NO;
  }
  const values = valuesOf(question, dialogue, scene);
  if (question.type === "attr") {
    const others = values.length > 2 ? values.filter(({ name }) => name !== question.value) : [];
    return [...YES_NO, ...ASIDES, ...others.map(spoken)];
  }
  if (question.type === "choice") {
    const known = scene?.attributes.find(({ name }) => name === question.attribute);
    const options = (known?.values ?? []).filter(({ name }) => question.values.includes(name));
    const isAll = options.length === known?.values.length;
    const none = isAll ? [] : [offer("none of them", "aside", "answer.none")];
    return [...options.map(spoken), ...none, ...ASIDES];
  }
  return question.type === "which" ? [...values.map(spoken), ...ASIDES] : [];
}

/** @returns {Offer} */
const spoken = (value) => offer(value.spoken, "value");

/** The values of the attribute in question that a likely object has. */
function valuesOf({ attribute }, dialogue, scene) {
  const known = scene?.attributes.find(({ name }) => name === attribute);
  const likely = (scene?.objects ?? []).filter(
    ({ name }) => (dialogue.belief?.[name] ?? 1) >= UNLIKELY,
  );
  // Objects that are not listed may have any of them.
  const isAny = unlistedOf(scene ?? { objects: [] }, dialogue).share >= UNLIKELY;
  const has = (value) =>
    isAny || likely.some(({ attributes }) => attributes?.[attribute] === value);
  return (known?.values ?? []).filter(({ name }) => has(name)).slice(0, VALUES_MAX);
}

/**
 * All offers: answers to a question, remarks after a hand-over, examples
 * if nothing is requested yet.
 * @param {any} dialogue
 * @param {any} scene
 * @param {object|null|undefined} delivery the object handed over that can be refused
 * @returns {Offer[]}
 */
export function offers(dialogue, scene, delivery) {
  if (delivery) return AFTER_DELIVERY;
  if (dialogue?.interaction === 0 && answers(dialogue, scene).length === 0) {
    return (scene?.examples ?? []).map((text) => offer(text, "example"));
  }
  return answers(dialogue, scene);
}
