// @ts-check
/**
 * A duration for people: milliseconds, or seconds from one on.
 * @param {number|null|undefined} ms
 * @param {any} t
 * @returns {string} a dash for none
 */
export function duration(ms, t) {
  if (typeof ms !== "number") return "–";
  if (ms >= 1000) return t("unit.s", { x: t.number(ms / 1000, { maximumFractionDigits: 2 }) });
  return t("unit.ms", { x: t.number(ms, { maximumFractionDigits: ms < 10 ? 1 : 0 }) });
}
