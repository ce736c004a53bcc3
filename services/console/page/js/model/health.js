// @ts-check
/**
 * A service in the section `group`.
 * @typedef {object} Service
 * @property {string} name
 * @property {"up"|"down"} wanted
 * @property {"down"|"starting"|"ready"|"stopping"|"backoff"|"held"} actual
 * @property {string|null} [why] why it is not in the wanted state
 * @property {string|null} [says] its own status
 * @property {{text: string}|null} [last_exit]
 * @property {number} restarts
 */

/**
 * The state of a service in one word: `service.WORD` of the strings.
 * @param {Service} service
 */
export function stateOf({ wanted, actual }) {
  return actual === "down" && wanted === "up" ? "waiting" : actual;
}

/**
 * The reason for its state, its own status, and how its previous run ended.
 * @param {Service} service
 * @param {(key: string, args?: object) => string} t
 */
export function noteOf({ why, says, last_exit }, t) {
  const exit = last_exit ? t("services.ended", { how: last_exit.text }) : null;
  return [why, says, exit].filter(Boolean).join("; ");
}

/**
 * Classifies a state as good, bad or neutral.
 * @param {string} state
 * @returns {"good"|"busy"|"bad"}
 */
export function tone(state) {
  if (state === "ready") return "good";
  return state === "held" || state === "down" ? "bad" : "busy";
}

/**
 * Summarises the group's health in one line: the gravest problem first.
 * @param {Service[]|undefined} services
 * @returns {{tone: "good"|"busy"|"bad", key: string, args: Record<string, string|number>}}
 */
export function health(services) {
  if (!services?.length) return { tone: "busy", key: "services.none", args: {} };
  for (const grave of /** @type {const} */ (["bad", "busy"])) {
    const affected = services.filter((service) => tone(stateOf(service)) === grave);
    const names = affected.map(({ name }) => name);
    if (names.length === 0) continue;
    const args = { names: names.join(", "), n: names.length };
    return { tone: grave, key: `health.${grave}`, args };
  }
  return { tone: "good", key: "health.good", args: { n: services.length } };
}
