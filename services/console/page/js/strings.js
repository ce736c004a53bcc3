// @ts-check
import { addressOf } from "./place.js";

/** Languages that the page speaks; the first one supplies missing words. */
export const LANGUAGES = ["en", "de"];

/**
 * A translator over one or several string tables, the first that has the key counts.
 * `{name}` in a text is replaced by `args.name`; numbers are written as the language does. Where
 * `args.n` is a number and there is a `key.one`, `key.other` …, the language's plural form is taken.
 * @param {string} language
 * @param {Record<string, string>[]} tables
 */
export function translator(language, tables) {
  const plural = new Intl.PluralRules(language);
  const number = new Intl.NumberFormat(language, { maximumFractionDigits: 2 });
  const find = (key) => {
    for (const table of tables) if (Object.hasOwn(table, key)) return table[key];
    return undefined;
  };
  /**
   * @param {string} key
   * @param {Record<string, string|number>} [args]
   * @returns {string}
   */
  const t = (key, args = {}) => {
    const form = typeof args.n === "number" ? find(`${key}.${plural.select(args.n)}`) : undefined;
    const text = form ?? find(key) ?? find(`${key}.other`) ?? key;
    return text.replace(/\{(\w+)\}/g, (whole, name) => {
      const value = args[name];
      if (value === undefined) return whole;
      return typeof value === "number" ? number.format(value) : value;
    });
  };
  t.language = () => language;
  t.has = (key) => find(key) !== undefined;
  /** @param {number} value @param {Intl.NumberFormatOptions} [options] */
  t.number = (value, options) => new Intl.NumberFormat(language, options).format(value);
  /** @param {number} share of one @param {number} [digits] after the point */
  t.percent = (share, digits = 0) =>
    t.number(share, { style: "percent", maximumFractionDigits: digits });
  return t;
}

/** The tables that `t` reads; empty before `loadStrings`. @type {ReturnType<typeof translator>} */
let current = translator("en", [{}]);

/**
 * The page's translator.
 * @param {string} key
 * @param {Record<string, string|number>} [args]
 */
export const t = Object.assign((key, args) => current(key, args), {
  has: (key) => current.has(key),
  number: (value, options) => current.number(value, options),
  percent: (share, digits) => current.percent(share, digits),
  language: () => current.language(),
});

/**
 * Chooses the language: the address, then the previous choice, then the browser's.
 * @param {string} search the address's query
 * @param {string|null} kept
 * @param {readonly string[]} wished the browser's languages
 * @returns {string}
 */
export function chooseLanguage(search, kept, wished) {
  const asked = new URLSearchParams(search).get("lang");
  const all = [asked, kept, ...wished].map((code) => (code ?? "").toLowerCase().split("-")[0]);
  return all.find((code) => LANGUAGES.includes(code)) ?? LANGUAGES[0];
}

/**
 * Loads the tables of a language; missing words are in English.
 * @param {string} language
 * @param {string[]} [parts] of a page that has more words, `strings/PART.CODE.json`: they count first
 */
export async function loadStrings(language, parts = []) {
  const codes = [...new Set([language, LANGUAGES[0]])];
  const names = codes.flatMap((code) => [...parts.map((part) => `${part}.${code}`), code]);
  const tables = await Promise.all(names.map(table));
  current = translator(language, tables);
  document.documentElement.lang = language;
}

/** Number of attempts while the console is restarting. */
const TRIES = 4;
/** Delay between attempts, milliseconds. */
const TRY_AGAIN_MS = 400;

/**
 * Without its words the page still works, stop first of all: it shows their keys then.
 * @param {string} name
 * @returns {Promise<Record<string, string>>}
 */
async function table(name) {
  for (let attempt = 1; attempt <= TRIES; attempt++) {
    try {
      const answer = await fetch(addressOf(`/strings/${name}.json`));
      return answer.ok ? await answer.json() : {};
    } catch {
      await new Promise((resolve) => setTimeout(resolve, TRY_AGAIN_MS));
    }
  }
  return {};
}

const ATTRIBUTES = { t: "", tLabel: "aria-label", tTitle: "title", tPlaceholder: "placeholder" };

/**
 * Fills in the texts of static elements: `data-t`, `data-t-label`, `data-t-title`,
 * `data-t-placeholder` hold keys.
 * @param {ParentNode} root
 */
export function translate(root) {
  const marked = "[data-t],[data-t-label],[data-t-title],[data-t-placeholder]";
  for (const node of /** @type {NodeListOf<HTMLElement>} */ (root.querySelectorAll(marked))) {
    for (const [mark, attribute] of Object.entries(ATTRIBUTES)) {
      const key = node.dataset[mark];
      if (key === undefined) continue;
      if (attribute) node.setAttribute(attribute, t(key));
      else node.textContent = t(key);
    }
  }
}
