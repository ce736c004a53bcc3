// @ts-check
/**
 * A service in the section `group`.
 * @typedef {object} Service
 * @property {string} name
 * @property {State} state its state in one word: `service.WORD` of the strings
 * @property {string|null} [why] why it is not in the wanted state
 * @property {string|null} [says] its own status
 * @property {{text: string}|null} [last_exit]
 * @property {number} restarts
 */

/**
 * @typedef {"down"|"waiting"|"starting"|"ready"|"stopping"|"restarting"|"short"|"held"|"failed"} State
 */

/**
 * Meaning of a state to a person: held is not failed, and neither is waiting for space.
 * @type {Record<State, {tone: Tone, act: "restart"|"start"|"release"|"retry"}>}
 */
const STATES = {
  ready: { tone: "good", act: "restart" },
  waiting: { tone: "busy", act: "restart" },
  starting: { tone: "busy", act: "restart" },
  stopping: { tone: "busy", act: "restart" },
  restarting: { tone: "busy", act: "restart" },
  short: { tone: "short", act: "retry" },
  held: { tone: "off", act: "release" },
  down: { tone: "off", act: "start" },
  failed: { tone: "bad", act: "retry" },
};

/** @typedef {"unknown"|"good"|"busy"|"short"|"off"|"bad"} Tone the worst last */

/**
 * The reason for its state, its own status, and how its previous run ended.
 * @param {Service} service
 * @param {(key: string, args?: object) => string} t
 */
export function noteOf({ state, why, says, last_exit }, t) {
  const exit = last_exit ? t("services.ended", { how: last_exit.text }) : null;
  // A state of held or switched off already says the same.
  const reason = tone(state) === "off" ? null : why;
  return [reason, says, exit].filter(Boolean).join("; ");
}

/**
 * Cause of a held robot: a service and its state.
 * @param {import("../now.js").Now} now
 * @param {(key: string, args?: object) => string} t
 */
export function serviceWords({ service }, t) {
  const { name, state } = service ?? { name: "", state: "unknown" };
  return t("question.held.words", { service: name, state: t(`service.${state}`) });
}

/**
 * Classifies a state.
 * @param {State} state
 * @returns {Tone}
 */
export function tone(state) {
  return STATES[state]?.tone ?? "busy";
}

/**
 * Name of its button's action: `services.act.NAME` of the strings.
 * @param {State} state
 */
export function actOf(state) {
  return STATES[state]?.act ?? "restart";
}

/**
 * Summarises the group's health in one line: the gravest problem first.
 * @param {Service[]|undefined} services
 * @param {boolean} [isStale] without a connection nothing is known
 * @returns {{tone: Tone, key: string, args: Record<string, string|number>}}
 */
export function health(services, isStale = false) {
  if (isStale) return { tone: "unknown", key: "health.unknown", args: {} };
  if (!services?.length) return { tone: "busy", key: "services.none", args: {} };
  for (const grave of /** @type {const} */ (["bad", "short", "off", "busy"])) {
    const affected = services.filter(({ state }) => tone(state) === grave);
    const names = affected.map(({ name }) => name);
    if (names.length === 0) continue;
    const args = { names: names.join(", "), n: names.length };
    return { tone: grave, key: `health.${grave}`, args };
  }
  return { tone: "good", key: "health.good", args: { n: services.length } };
}
