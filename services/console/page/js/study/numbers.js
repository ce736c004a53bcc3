// @ts-check
/**
 * A number with its interval: `[value, interval]`, each empty if missing.
 * @param {number|null|undefined} value
 * @param {number|null|undefined} low
 * @param {number|null|undefined} high
 * @param {(value: number) => string} write
 * @returns {[string, string]}
 */
export function withInterval(value, low, high, write) {
  if (value === null || value === undefined) return ["–", ""];
  const known = typeof low === "number" && typeof high === "number";
  return [write(value), known ? `[${write(low)}, ${write(high)}]` : ""];
}

/**
 * The cells of a policy's row.
 * @param {any} group of the report
 * @param {any} t
 * @returns {[string, string][]}
 */
export function policyCells(group, t) {
  const percent = (value) => t.percent(value, 1);
  const { success, success_low: low, success_high: high } = group;
  return [
    [String(group.participants), ""],
    [String(group.interactions), ""],
    group.interactions > 0 ? withInterval(success, low, high, percent) : ["–", ""],
    meanCell(group.seconds, t, 1),
    meanCell(group.questions, t, 2),
  ];
}

/**
 * The cells of a comparison's row; differences carry their sign.
 * @param {any} paired
 * @param {any} t
 * @returns {[string, string][]}
 */
export function pairedCells(paired, t) {
  const points = (value) =>
    t.number(value, { style: "percent", maximumFractionDigits: 1, signDisplay: "exceptZero" });
  const { mean, low, high } = paired.success;
  const signed = (digits) => (value) =>
    t.number(value, {
      minimumFractionDigits: digits,
      maximumFractionDigits: digits,
      signDisplay: "exceptZero",
    });
  const of = (one, digits) => withInterval(one.mean, one.low, one.high, signed(digits));
  return [
    [String(paired.participants), ""],
    withInterval(mean, low, high, points),
    of(paired.seconds, 1),
    of(paired.questions, 2),
  ];
}

function meanCell({ mean, low, high }, t, digits) {
  const write = (value) =>
    t.number(value, { minimumFractionDigits: digits, maximumFractionDigits: digits });
  return withInterval(mean, low, high, write);
}

/** The pictures that there is something to show in. @param {any} report */
export function picturesOf(report) {
  const pictures = report.all.interactions > 0 ? ["success", "seconds", "questions"] : [];
  const scaled = report.questionnaire.some((item) => item.points > 0 && item.mean?.n > 0);
  return scaled ? [...pictures, "questionnaire"] : pictures;
}
