// @ts-check
import { eachFrame, h, setAttribute, setText } from "../dom.js";
import { openSheet } from "../sheet.js";
import { notify } from "../views/attempt.js";
import { scenesApi } from "./api.js";
import { iconButton } from "./buttons.js";
import { about } from "./document.js";
import { filesBar } from "./files_bar.js";
import { problemsView } from "./problems.js";
import { SceneSession } from "./session.js";
import { sideView } from "./side.js";
import { thingState } from "./thing_state.js";
import { topView } from "./top.js";

/**
 * The scene editor: a sheet with the table from above, the chosen object, the words, and every problem.
 * @param {{store: any, t: any, session: string}} context
 * @returns {Promise<() => void>} opens it
 */
export async function mountScene({ store, t, session: page }) {
  await loadStyle();
  const isOperator = () => {
    const operator = store.get("control")?.operator ?? null;
    return operator !== null && operator === store.get("welcome")?.viewer;
  };
  const onChange = () => draw();
  const session = new SceneSession(scenesApi(page), { t, isOperator, onChange, notify });
  const top = topView(t, {
    choose: (n) => {
      session.choose(n);
      side.show("object");
    },
    change: (n, f, what) => session.changeObject(n, f, what),
    settle: () => session.draft?.settle(),
  });
  const side = sideView(t, session, (n) => {
    drawNow();
    top.focus(n);
  });
  const problems = problemsView(t, {
    go: side.go,
    move: (n, place) => session.changeObject(n, (object) => Object.assign(object, { xyz: place })),
  });
  const files = filesBar(t, session);
  const note = h("p", { class: "scene-note", role: "status" });
  const status = h("p", { class: "thing-state", "aria-live": "polite" });
  const keys = h("p", { class: "scene-keys", text: t("scene.keys") });
  const close = iconButton(t("scene.close"), "close", () => dialog.close());
  const title = h("h2", { id: "scene-title", text: t("scene.title") });
  const dialog = h(
    "dialog",
    { class: "help scene", "aria-labelledby": "scene-title", tabindex: "-1" },
    h("div", { class: "help-head" }, title, files.element, close),
    note,
    h(
      "div",
      { class: "scene-body" },
      h("div", { class: "scene-picture" }, top.element, status, keys, problems.element),
      side.element,
    ),
  );
  dialog.addEventListener("keydown", onKey);
  document.body.append(dialog);
  addEventListener("beforeunload", (event) => {
    if (dialog.open && session.draft?.isChanged) event.preventDefault();
  });

  function onKey(event) {
    const isText = event.target.matches?.("input, textarea, select");
    if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === "z" && !isText) {
      session.step(event.shiftKey ? "redo" : "undo");
    } else if (event.key === "Delete" && event.target.closest?.(".thing, .thing-list")) {
      session.remove();
      drawNow();
      if (session.chosen !== null) top.focus(session.chosen);
    } else return;
    event.preventDefault();
  }

  function noteText() {
    if (session.note) return session.note;
    if (session.draft && !session.isBusy && !isOperator()) return t("scene.look_only");
    return session.listed.locked ?? "";
  }
  function drawNow() {
    if (!dialog.open) return;
    const { draft, robot, chosen, reach, findings, canEdit, isBusy } = session;
    files.draw();
    setText(note, noteText());
    setAttribute(dialog, "data-busy", isBusy);
    setAttribute(dialog, "data-locked", !canEdit && !isBusy);
    setAttribute(dialog, "data-check", findings.state);
    setAttribute(dialog, "data-reach", reach?.isComplete ? "known" : null);
    if (!draft) return;
    const concerned = findings.problems.map(about).filter(({ kind }) => kind === "object");
    const wrong = new Set(concerned.map(({ n }) => n));
    top.draw({ document: draft.document, robot, chosen, reach, wrong, canEdit });
    side.draw(wrong);
    setText(status, thingState(session, t));
    problems.draw(findings, canEdit);
  }
  const draw = eachFrame(drawNow);
  store.subscribe(["control", "welcome"], () => {
    if (!dialog.open) return;
    session.rest();
    draw();
  });
  return () => {
    if (dialog.open) return;
    openSheet(dialog, store);
    dialog.focus();
    session.begin();
  };
}

/** Loads the style of the editor; without it, it works, too. */
function loadStyle() {
  const href = new URL("../../css/scene.css", import.meta.url).href;
  return new Promise((resolve) => {
    document.head.append(h("link", { rel: "stylesheet", href, onload: resolve, onerror: resolve }));
  });
}
