// @ts-check
/**
 * @typedef {"off"|"loading"|"offline"|"welcome"|"busy"|"consent"|"instructions"|"drawn"|"running"|
 *   "over"|"questionnaire"|"thanks"|"withdrawn"|"left"} Screen
 */

/**
 * Which screen the participant's page shows.
 * @param {object} known
 * @param {string|null} known.me the participant's code, null before the beginning
 * @param {any} known.study the section, undefined before it is known
 * @param {any} known.welcome
 * @returns {Screen}
 */
export function screenOf({ me, study, welcome }) {
  if (welcome && !welcome.settings?.study) return "off";
  if (!study || !welcome) return "loading";
  const person = participantOf(me, study);
  if (person) return person.stage;
  return study.active ? "busy" : "welcome";
}

/**
 * The participant whom the page is about.
 * @param {string|null} me
 * @param {any} study
 */
export function participantOf(me, study) {
  const people = [study?.active, study?.last];
  return (me !== null && people.find((person) => person?.participant === me)) || null;
}

/**
 * Returns the progress line: a key with its arguments, null if empty.
 * @param {any} person
 * @returns {[string, Record<string, number>]|null}
 */
export function progressOf(person) {
  const trial = person?.trial;
  if (!trial || !["drawn", "running", "over"].includes(person.stage)) return null;
  if (trial.practice) return ["study.practice", {}];
  return ["study.progress", { n: trial.number, total: person.total }];
}

/**
 * The string's key for the end of an interaction.
 * @param {any} trial
 */
export function outcomeKey(trial) {
  return `study.outcome.${trial?.outcome ?? "fault"}`;
}

/**
 * The desired object in the scene, with its attributes in words.
 * @param {any} scene
 * @param {string|undefined} name
 * @returns {{object: any, values: {attribute: string, spoken: string}[]}|null}
 */
export function desiredIn(scene, name) {
  const object = scene?.objects.find((one) => one.name === name);
  if (!object) return null;
  const values = scene.attributes.flatMap((attribute) => {
    const value = object.attributes[attribute.name];
    if (value === undefined) return [];
    const known = attribute.values.find((one) => one.name === value);
    return [{ attribute: attribute.name, spoken: known?.spoken ?? value }];
  });
  return { object, values };
}

/** Decisions in which the robot says something to the person. */
const SPOKEN = ["ask", "say", "pick"];

/**
 * Returns the robot's current sentence, empty if none.
 * @param {any} dialogue
 * @param {any} trial the running one
 */
export function robotWords(dialogue, trial) {
  if (!dialogue || !trial?.said) return "";
  return SPOKEN.includes(dialogue.decision) ? dialogue.text : "";
}

/**
 * The last thing that the person said since the interaction began.
 * @param {any[]|undefined} lines
 * @param {number|null|undefined} since milliseconds since 1970
 */
export function lastHeard(lines, since) {
  if (!lines || !since) return null;
  const isMine = (line) => line.who === "person" || line.who === "unmeant";
  const line = lines.findLast((one) => isMine(one) && (one.unix_ms ?? 0) >= since - 2_000);
  return line ? { text: line.text, meant: line.who === "person" } : null;
}

/**
 * The answers as the server takes them, and the ids of required ones that are missing.
 * @param {any[]} items the questionnaire
 * @param {(id: string) => string|null} value the choice or text
 * @returns {{answers: Record<string, string|number>, missing: string[]}}
 */
export function answersOf(items, value) {
  /** @type {Record<string, string|number>} */
  const answers = {};
  const missing = [];
  for (const item of items) {
    const text = value(item.id)?.trim() ?? "";
    const isNumber = item.kind === "likert" || item.kind === "number";
    const number = Number(text.replace(",", "."));
    if (text === "" || (isNumber && !Number.isFinite(number))) {
      if (item.required || text !== "") missing.push(item.id);
    } else {
      answers[item.id] = isNumber ? number : text;
    }
  }
  return { answers, missing };
}

/**
 * The paragraphs of a text.
 * @param {string} text
 */
export function paragraphs(text) {
  return text
    .split(/\n\s*\n/)
    .map((part) => part.trim())
    .filter((part) => part !== "");
}
