// @ts-check
import { eachFrame, h } from "../dom.js";
import { icon } from "../icons.js";
import { KEYS, NOWHERE, settle } from "./model.js";
import { buildView } from "./view.js";

/**
 * The sheet with the past interactions; each can be stepped through.
 * @param {{store: any, t: any}} context
 * @returns {() => void} opens it
 */
export function mountHistory({ store, t }) {
  loadStyle();
  /** @type {import("./model.js").Past[]} */
  let history = [];
  let at = NOWHERE;
  const go = (place) => {
    at = settle(history, place);
    view.draw(history, at);
  };
  const view = buildView(t, go);
  const close = { type: "button", class: "tool", "aria-label": t("history.close") };
  const dialog = h(
    "dialog",
    { class: "help history", "aria-labelledby": "history-title" },
    h(
      "div",
      { class: "help-head" },
      h("h2", { id: "history-title", text: t("history.title") }),
      h("button", { ...close, onclick: () => dialog.close() }, icon("close", 22)),
    ),
    view.element,
  );
  dialog.addEventListener("keydown", (event) => {
    const move = KEYS[event.key];
    if (!move || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    go(move(history, at));
  });
  document.body.append(dialog);

  const fetchNow = async () => {
    try {
      const answer = await fetch("/api/history");
      if (answer.ok) history = await answer.json();
      view.fail(!answer.ok);
    } catch {
      view.fail(true);
    }
    go(at);
  };
  const follow = eachFrame(() => dialog.open && fetchNow());
  store.subscribe("dialogue", follow);
  store.subscribe("link", ({ state }) => state === "up" && follow());
  return () => {
    if (dialog.open) return;
    at = NOWHERE;
    dialog.showModal();
    fetchNow();
  };
}

function loadStyle() {
  const href = new URL("../../css/history.css", import.meta.url).href;
  document.head.append(h("link", { rel: "stylesheet", href }));
}
