// @ts-check
import { eachFrame, h, keyed, setAttribute, setText } from "../dom.js";
import { conversation } from "../model/conversation.js";
import { makeLine } from "./line.js";

/** Distance from its end at which the transcript follows new lines, pixels. */
const NEAR_PX = 80;

/**
 * The conversation, with the understood meaning of each utterance, and the words in progress.
 * @param {HTMLElement} element
 * @param {{store: any, t: any}} context
 */
export function mountTranscript(element, { store, t }) {
  const log = { class: "lines", role: "log", "aria-live": "off", "aria-label": t("talk.log") };
  const list = h("div", { ...log, tabindex: 0 });
  const empty = h("p", { class: "empty", text: t("talk.empty") });
  const words = h("p", { class: "words" });
  const live = h("div", { class: "line partial", "data-who": "person", hidden: true }, words);
  const newer = h("button", {
    type: "button",
    class: "newer",
    text: t("talk.newer"),
    hidden: true,
  });
  const place = h("div", {});
  list.append(empty, place, live);
  element.append(list, newer);
  let follows = true;

  list.addEventListener(
    "scroll",
    () => {
      follows = list.scrollHeight - list.scrollTop - list.clientHeight < NEAR_PX;
      if (follows) newer.hidden = true;
    },
    { passive: true },
  );
  newer.addEventListener("click", () => toEnd());
  function toEnd() {
    follows = true;
    newer.hidden = true;
    list.scrollTop = list.scrollHeight;
  }
  new ResizeObserver(() => follows && toEnd()).observe(list);

  /** A line that was sent again is another object: its parent is redrawn. */
  const versions = new WeakMap();
  let version = 0;
  const versionOf = (line) => {
    if (!versions.has(line)) versions.set(line, ++version);
    return versions.get(line);
  };
  const key = ({ lines }) => lines.map(versionOf).join();

  let last = 0;
  const draw = eachFrame(() => {
    const lines = store.get("lines") ?? [];
    const partial = store.get("partial");
    const items = conversation(lines);
    keyed(place, items, key, (item) => makeLine(item, t), mark);
    empty.hidden = items.length > 0 || Boolean(partial?.text);
    live.hidden = !partial?.text;
    setText(words, partial?.text ?? "");
    const newest = lines.at(-1)?.id ?? 0;
    if (follows) toEnd();
    else if (newest > last) newer.hidden = false;
    last = newest;
    setAttribute(element, "data-empty", lines.length === 0);
  });
  /** The pending question is marked: a narrow page shows it once, in large type. */
  function mark(node, { line }) {
    const dialogue = store.get("dialogue");
    const stands = dialogue?.interaction > 0 && line.said?.[0] === dialogue.prompt;
    setAttribute(node, "data-stands", stands);
  }
  store.subscribe(["lines", "partial", "dialogue"], draw);
  draw();
}
