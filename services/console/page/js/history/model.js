// @ts-check
/**
 * The server's data about an interaction; see docs/console.md.
 * @typedef {object} Moment
 * @property {number} after_ms since the first words
 * @property {any} event its `type`, and further data
 * @property {{belief: number[], absent: number, decision: any}|null} thought none if it changed neither
 *
 * @typedef {object} End
 * @property {string} outcome
 * @property {{name: string, label: string}|null} object
 * @property {number} questions
 * @property {number} duration_s
 *
 * @typedef {object} Interaction
 * @property {number} interaction
 * @property {number|null} unix_ms
 * @property {boolean} whole
 * @property {{name: string, label: string}[]} objects
 * @property {Moment[]} moments
 * @property {number} left_out
 * @property {End|null} end
 *
 * @typedef {object} Summary
 * @property {number} interaction
 * @property {number|null} unix_ms
 * @property {string} text
 * @property {End|null} end
 */

/**
 * A place in an interaction: a moment, or its end.
 * @typedef {object} Step
 * @property {number} after_ms
 * @property {any} event of type `end` for the end
 * @property {any} thought the latest up to here, null before the first
 * @property {number[]|null} before the belief one step earlier
 * @property {string} line words of the robot here, if any
 */

/**
 * The places of an interaction in the order of time.
 * @param {Interaction} past
 * @returns {Step[]}
 */
export function stepsOf(past) {
  /** @type {Step[]} */
  const steps = [];
  let thought = null;
  let said = "";
  for (const moment of past.moments.filter(isNews)) {
    const before = thought?.belief ?? null;
    thought = moment.thought ?? thought;
    const { prompt, presentation, text } = moment.thought?.decision ?? {};
    const line = text ? `${prompt}.${presentation} ${text}` : said;
    const isNew = line !== said;
    said = line;
    steps.push({ ...moment, thought, before, line: isNew ? text : "" });
  }
  if (past.end) {
    // The policy's last step ended it; the arm returns to rest afterwards.
    const last = past.moments.findLastIndex((moment) => moment.thought !== null);
    const place = last < 0 ? steps.length : last + 1;
    const after_ms = steps[place - 1]?.after_ms ?? past.end.duration_s * 1_000;
    const event = { type: "end", ...past.end };
    steps.splice(place, 0, { after_ms, event, thought, before: thought?.belief ?? null, line: "" });
  }
  return steps;
}

/** The dialogue's record of an order to the motion stop, by the order. */
const MOTION = { stop: ["stopped", "stop_confirmed"], resume: ["released"] };

/** Whether a moment says something new: of a stop and a release the arm's own record says the same again. */
function isNews({ event, thought }, k, moments) {
  const same = event.cause?.type === "motion" ? (MOTION[event.cause.order] ?? []) : [];
  const isTold = (other) => same.includes(other?.event.type);
  return thought !== null || !(isTold(moments[k - 1]) || isTold(moments[k + 1]));
}

/**
 * The place after a move, within the interaction.
 * @param {number} count of its places
 * @param {number} at
 * @param {number} by
 */
export const move = (count, at, by) => Math.max(0, Math.min(count - 1, at + by));

/**
 * Words for an event: a key of the strings with its arguments.
 * @param {any} event
 * @param {Interaction} past
 * @returns {{key: string, args: Record<string, any>}}
 */
export function eventWords(event, past) {
  const label = (name) => past.objects.find((object) => object.name === name)?.label ?? name;
  if (event.type === "end") return endWords(event);
  if (event.type === "pick_ended") {
    return { key: `history.pick.${event.outcome}`, args: {} };
  }
  if (event.type !== "arm") return { key: `history.event.${event.type}`, args: {} };
  const { cause, pick } = event;
  const args = { object: label(pick.object) };
  if (cause.type === "motion") return { key: `history.arm.${cause.order}`, args };
  if (["missed", "rested", "blocked"].includes(cause.type)) {
    return { key: `history.arm.${cause.type}`, args };
  }
  if (pick.phase === "done") return { key: `history.pick.${pick.outcome}`, args };
  const task = pick.task === "put_back" ? "put_back." : "";
  return { key: `history.arm.${task}${pick.phase}`, args };
}

/**
 * Words for the end of an interaction, or that there is none yet.
 * @param {End|null} end
 */
export function endWords(end) {
  if (!end) return { key: "history.open", args: {} };
  return { key: `history.${end.outcome}`, args: { object: end.object?.label ?? "" } };
}

/** Who acted: its drawing and its colour. @param {any} event */
export function actorOf(event) {
  if (event.type === "heard") return "person";
  if (event.cause?.type === "motion") return event.cause.order === "stop" ? "stop" : "release";
  if (event.type.startsWith("stop")) return "stop";
  if (event.type === "released") return "release";
  if (event.type === "arm" || event.type === "pick_ended") return "arm";
  return event.type === "end" ? "end" : "system";
}

/**
 * A decision as the reasons are drawn from.
 * @param {any} decision
 */
export function reasonsOf(decision) {
  return {
    decision: decision.type,
    question: decision.question,
    value: decision.value_s,
    bounds: decision.bounds_s,
    expected_questions: decision.expected_questions,
    alternatives: decision.alternatives.map(({ action, value_s }) => ({ action, value: value_s })),
  };
}

/** Mark of a shared file. */
export const FORMAT = "whichone.interaction/1";

/**
 * The text of a file with one interaction.
 * @param {Interaction} past
 * @param {{group: string, version: string}} from
 */
export function fileOf(past, { group, version }) {
  return `${JSON.stringify({ format: FORMAT, group, version, ...past }, null, 1)}\n`;
}

/**
 * The interaction in a file that was shared.
 * @param {string} text
 * @returns {Interaction|null} null: it is another file
 */
export function interactionOf(text) {
  try {
    const file = JSON.parse(text);
    const isWhole =
      file.format === FORMAT &&
      Number.isSafeInteger(file.interaction) &&
      isListOf(file.objects, ({ name, label }) => isText(name) && isText(label)) &&
      isListOf(file.moments, isMoment) &&
      (file.end === null || (isText(file.end?.outcome) && isNumber(file.end.duration_s)));
    return isWhole ? file : null;
  } catch {
    return null;
  }
}

const isText = (value) => typeof value === "string";
const isNumber = (value) => Number.isFinite(value);
const isListOf = (value, fits) => Array.isArray(value) && value.every(fits);

function isMoment({ after_ms, event, thought }) {
  const isKnown =
    thought === null || (isListOf(thought?.belief, isNumber) && isDecision(thought.decision));
  const heard =
    event?.type !== "heard" || (isListOf(event.readings, isShare) && isText(event.text));
  const answers =
    event?.type !== "heard" || isListOf(event.answers, ({ share }) => isNumber(share));
  const arm = event?.type !== "arm" || (isText(event.pick?.phase) && isText(event.cause?.type));
  return isNumber(after_ms) && isText(event?.type) && isKnown && heard && answers && arm;
}

const isShare = ({ text, weight }) => isText(text) && isNumber(weight);

function isDecision(decision) {
  const fits = ({ action, value_s }) => isText(action?.type) && isNumber(value_s);
  return isText(decision?.type) && isListOf(decision.alternatives, fits);
}
