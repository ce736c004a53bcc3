// @ts-check
import { clockOf, eachFrame, h, keyed } from "../dom.js";
import { events } from "../model/conversation.js";
import { noteWords } from "../model/notes.js";

/** Most events that are listed. */
const MOST = 30;

/**
 * Events besides the conversation: services, stops, and this page's connection.
 * @param {HTMLElement} element
 * @param {{store: any, t: any}} context
 */
export function mountEvents(element, { store, t }) {
  const list = h("ol", { class: "event-list", "aria-labelledby": "events-heading" });
  const empty = h("p", { class: "empty", text: t("events.none") });
  element.append(h("h3", { id: "events-heading", text: t("events.heading") }), empty, list);
  const own = outages(store, () => draw());

  const make = (event) =>
    h(
      "li",
      { class: "event" },
      h("time", { class: "clock", text: clockOf(event, t.language()) }),
      h("span", { text: noteWords(event, t) }),
    );
  const key = (event) => `${event.id ?? event.note.type}.${event.unix_ms}`;
  const draw = eachFrame(() => {
    const shown = events(store.get("lines") ?? [], own, MOST);
    empty.hidden = shown.length > 0;
    keyed(list, shown, key, make);
  });
  store.subscribe("lines", draw);
  draw();
}

/** The outages of this page's connection, as notes; the list grows. */
function outages(store, changed) {
  const notes = [];
  let lost = false;
  const add = (type) => {
    notes.push({ who: "system", text: "", unix_ms: Date.now(), note: { type } });
    notes.splice(0, notes.length - MOST);
    changed();
  };
  store.subscribe("now", ({ is, why }) => {
    if (why === "connecting" || lost === (is === "disconnected")) return;
    lost = !lost;
    add(lost ? "link_lost" : "link_back");
  });
  return notes;
}
