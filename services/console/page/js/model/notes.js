// @ts-check
/**
 * A note of the system in the page's language.
 * @param {{text: string, outcome?: string, note?: any}} line
 * @param {any} t
 * @returns {string}
 */
export function noteWords({ text, outcome, note }, t) {
  if (!note) return text;
  if (note.type === "ended") return endWords({ ...note, outcome }, t);
  const { service, exit } = note;
  const words = t(`note.${note.type}`, { service: service ?? "" });
  return exit ? `${words} (${t("services.ended", { how: exit })})` : words;
}

/**
 * How a request ended.
 * @param {{outcome?: string, object: string|null, questions: number, seconds: number}} end
 * @param {any} t
 * @returns {string}
 */
export function endWords({ outcome, object, questions, seconds }, t) {
  const digit = { maximumFractionDigits: 1 };
  const args = { object: object ?? "", n: questions, seconds: t.number(seconds, digit) };
  const key = `last.${outcome}`;
  return questions === 0 && t.has(`${key}.none`) ? t(`${key}.none`, args) : t(key, args);
}
