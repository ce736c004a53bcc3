// @ts-check
import { eachFrame, h, setText } from "../dom.js";
import { icon } from "../icons.js";
import { addressOf } from "../place.js";
import { openSheet } from "../sheet.js";
import { notify } from "../views/attempt.js";
import { linked, linkTo } from "./address.js";
import { listView } from "./list.js";
import { oneView } from "./one.js";
import { copyLink, download } from "./share.js";
import { fetchOne, Source } from "./source.js";

/**
 * The sheet with the past interactions: a list, and one of them step by step.
 * @param {{store: any, t: any}} context
 * @returns {Promise<(interaction?: number) => void>} opens it, at an interaction
 */
export async function mountHistory({ store, t }) {
  await loadStyle();
  const source = new Source();
  /** The interaction that is looked at, 0 for none yet. */
  let current = 0;
  const list = listView(t, { choose: (interaction) => open(interaction, true), more });
  const one = oneView(t, tools(), "h3");
  const state = h("p", { class: "empty past-state", role: "status" });
  const toList = button("tool past-to-list", "before", "history.to_list", () => narrow(false));
  const close = button("tool", "close", "history.close", () => dialog.close());
  const files = h("a", { class: "past-open", href: addressOf("/history"), target: "_blank" });
  files.append(t("history.open_file"));
  const dialog = h(
    "dialog",
    { class: "help history", "aria-labelledby": "history-title", tabindex: "-1" },
    h("div", { class: "help-head" }, toList, title(), files, close),
    state,
    h("div", { class: "past" }, list.element, one.element),
  );
  dialog.addEventListener("keydown", onKey);
  dialog.addEventListener("close", () => {
    address("");
  });
  document.body.append(dialog);

  function title() {
    return h("h2", { id: "history-title", text: t("history.title") });
  }
  function button(kind, drawing, key, onclick) {
    const about = { type: "button", class: kind, "aria-label": t(key), title: t(key), onclick };
    return h("button", about, icon(drawing, 22));
  }
  function tools() {
    const save = () => {
      const past = one.shown();
      const { group = "whichone", version = "" } = store.get("welcome") ?? {};
      if (past) download(past, { group, version });
    };
    const copy = async () =>
      notify(t((await copyLink(current)) ? "history.copied" : "history.link"));
    return [
      button("tool", "link", "history.copy", copy),
      button("tool", "save", "history.save", save),
    ];
  }
  /** On a narrow screen, whether one interaction is shown, or the list. */
  function narrow(isOne) {
    dialog.toggleAttribute("data-one", isOne);
    if (!isOne) list.reveal(true);
  }
  function address(hash) {
    globalThis.history.replaceState(null, "", hash || location.pathname + location.search);
  }
  function draw() {
    list.draw(source, current);
    dialog.toggleAttribute("data-empty", source.list.length === 0);
    if (source.list.length === 0) setText(state, t("history.none"));
  }
  async function attempt(work) {
    try {
      await work();
      setText(state, "");
    } catch {
      setText(state, t("history.unavailable"));
    }
    draw();
  }
  async function more() {
    if (dialog.open) await attempt(() => source.more());
  }
  async function open(interaction, isChosen = false) {
    current = interaction;
    if (isChosen) narrow(true);
    await attempt(async () => {
      const past = interaction ? await fetchOne(interaction) : null;
      // Another one may have been chosen meanwhile.
      if (current !== interaction) return;
      one.show(past);
      if (interaction && !past) throw new Error("it is gone");
      if (dialog.open) address(linkTo(interaction));
    });
    list.reveal(false);
    // On a narrow screen the button that was pressed is gone, and with it the focus.
    if (isChosen && !list.element.checkVisibility()) one.focus();
  }
  const refresh = () =>
    attempt(async () => {
      await source.refresh();
      if (!current) current = source.list[0]?.interaction ?? 0;
      await open(current);
    });
  function onKey(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const by = { ArrowUp: -1, ArrowDown: 1 }[event.key];
    const inStory = event.target.closest?.(".story") !== null;
    if (by) {
      const place = source.list.findIndex(({ interaction }) => interaction === current);
      const next = source.list[place + by];
      const inList = event.target.closest?.(".past-list") !== null;
      if (next) open(next.interaction).then(() => list.reveal(inList));
      if (place + by >= source.list.length - 1) more();
    } else if (!one.onKey(event, inStory)) {
      return;
    }
    event.preventDefault();
  }

  const follow = eachFrame(() => dialog.open && refresh());
  store.subscribe("dialogue", follow);
  store.subscribe("arm", (arm) => ["done", "idle"].includes(arm?.phase) && follow());
  store.subscribe("link", ({ state: is }) => is === "up" && follow());
  const show = (interaction = 0) => {
    if (dialog.open && interaction === current) return;
    current = interaction;
    narrow(interaction > 0);
    if (!dialog.open) {
      openSheet(dialog, store);
      // The keys work at once, and no button looks chosen.
      dialog.focus();
    }
    refresh();
  };
  addEventListener("hashchange", () => {
    const interaction = linked(location.hash);
    if (interaction !== null) show(interaction);
  });
  return show;
}

/** Loads the style of the history's views; without it they work, too. */
function loadStyle() {
  const href = new URL("../../css/history.css", import.meta.url).href;
  return new Promise((resolve) => {
    document.head.append(h("link", { rel: "stylesheet", href, onload: resolve, onerror: resolve }));
  });
}
