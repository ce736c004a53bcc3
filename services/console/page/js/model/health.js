// @ts-check
const GOOD = ["ready", "running", "up"];
const BAD = ["failed", "held", "dead", "down", "stopped"];

/**
 * Whether a service does what it should.
 * @param {string} state
 * @returns {"good"|"busy"|"bad"}
 */
export function tone(state) {
  if (GOOD.includes(state)) return "good";
  return BAD.includes(state) ? "bad" : "busy";
}

/**
 * How the group is doing, in a line: the gravest first.
 * @param {{name: string, state: string}[]|undefined} services
 * @returns {{tone: "good"|"busy"|"bad", key: string, args: Record<string, string|number>}}
 */
export function health(services) {
  if (!services?.length) return { tone: "busy", key: "services.none", args: {} };
  for (const grave of /** @type {const} */ (["bad", "busy"])) {
    const names = services.filter(({ state }) => tone(state) === grave).map(({ name }) => name);
    if (names.length === 0) continue;
    const args = { names: names.join(", "), n: names.length };
    return { tone: grave, key: `health.${grave}`, args };
  }
  return { tone: "good", key: "health.good", args: { n: services.length } };
}
