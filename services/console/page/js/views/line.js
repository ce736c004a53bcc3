// @ts-check
import { clockOf, h } from "../dom.js";
import { noteWords } from "../model/notes.js";

/** Smaller shares of a question are not shown. */
const SMALL = 0.05;
/** A hypothesis as sure as that needs no figure. */
const SURE = 0.995;

/**
 * A line of the conversation, and how often it was said in a row.
 * @param {{line: any, lines: any[]}} item
 * @param {any} t
 * @returns {HTMLElement}
 */
export function makeLine({ line, lines }, t) {
  const speaker = h("span", { class: "hidden", text: `${t(`who.${line.who}`)}: ` });
  const text = noteWords(line, t) || t("talk.nothing");
  const time = clockOf(lines.at(-1), t.language());
  const clock = time ? h("time", { class: "clock", text: time }) : null;
  const words = h("p", { class: "words" }, speaker, text, clock && " ", clock);
  const notes = [...understood(line, t), ...circumstances(line, t)];
  if (lines.length > 1) {
    notes.push(h("span", { class: "note", text: t("line.times", { n: lines.length }) }));
  }
  const below = notes.length ? h("p", { class: "notes" }, ...notes) : null;
  return h("div", { class: "line", "data-who": line.who }, words, below);
}

/** The meanings, each a chip with its probability. */
function understood(line, t) {
  const all = line.understood ?? [];
  return all.slice(0, 5).map(({ text, weight }) => {
    const share = all.length > 1 || weight < SURE ? ` ${t.percent(weight)}` : "";
    const label = h("span", { class: "hidden", text: `${t("line.understood")} ` });
    return h("span", { class: "chip" }, label, text, share && h("b", { text: share }));
  });
}

function circumstances(line, t) {
  const notes = [];
  if (line.who === "unmeant") {
    const why = t(`line.verdict.${line.verdict ?? "other_talk"}`);
    notes.push(h("span", { class: "note strong", text: why }));
  }
  for (const { question, share } of line.answers ?? []) {
    // An announcement is not a question: to say that it was answered would confuse.
    if (share < SMALL || !question.endsWith("?")) continue;
    const percent = share < SURE ? ` ${t.percent(share)}` : "";
    notes.push(h("span", { class: "note", text: t("line.answers", { question }) + percent }));
  }
  if (typeof line.confidence === "number" && line.source !== "typed") {
    const share = t.percent(line.confidence);
    notes.push(h("span", { class: "note", text: t("line.confidence", { share }) }));
  }
  if (line.recognisers) notes.push(h("span", { class: "note", text: views(line.recognisers, t) }));
  if (line.who === "person" && line.source && line.source !== "typed") {
    notes.push(h("span", { class: "note", text: t(`source.${line.source}`) }));
  }
  return notes;
}

/** Result of each recogniser. */
function views({ first, second }, t) {
  if (second === undefined) return t("line.second.late", { first });
  return second ? t("line.second.heard", { first, second }) : t("line.second.silent", { first });
}
