// @ts-check
import { h, setAttribute } from "../dom.js";
import { textButton } from "./buttons.js";
import { objectPanel } from "./object_panel.js";
import { wordsPanel } from "./words_panel.js";

/**
 * The side of the editor: the list of objects, and the form of the chosen one or of the words.
 * @param {any} t
 * @param {import("./session.js").SceneSession} session
 * @param {(n: number) => void} focus brings the focus to an object in the picture
 */
export function sideView(t, session, focus) {
  let panel = "object";
  /** @type {{key: string, element: HTMLElement, show: () => void, reveal?: (k: number) => void}|null} */
  let form = null;
  const tabs = ["object", "words"].map((which) =>
    h("button", {
      type: "button",
      "data-panel": which,
      onclick: () => show(which),
      text: t(`scene.panel.${which}`),
    }),
  );
  const add = textButton(t("scene.add"), "plus", () => added(session.add(null)));
  const copy = textButton(t("scene.copy"), "copy", () => added(session.add(session.chosen)));
  const drop = textButton(t("scene.remove"), "close", remove);
  const things = h("div", { class: "thing-list", role: "group", "aria-label": t("scene.objects") });
  const objects = h(
    "div",
    { class: "thing-tools" },
    h("div", { class: "row" }, add, copy, drop),
    things,
  );
  const body = h("div", { class: "scene-panel" });
  const nav = h("nav", { class: "scene-tabs", "aria-label": t("scene.panels") }, ...tabs);
  const element = h("div", { class: "scene-side" }, nav, objects, body);

  function added(n) {
    if (n !== undefined) goTo(n);
  }
  function remove() {
    session.remove();
    draw();
    if (session.chosen !== null) focus(session.chosen);
  }
  function show(which) {
    panel = which;
    draw();
  }
  /** Shows an object's form, with the focus on the object. @param {number} n */
  function goTo(n) {
    session.choose(n);
    show("object");
    focus(n);
  }
  /** Shows the subject of a problem. @param {{kind: string, n: number}} what */
  function go({ kind, n }) {
    if (kind === "object") return goTo(n);
    show("words");
    if (n >= 0) form?.reveal?.(n);
  }

  /** @param {Set<number>} [wrong] objects with a problem */
  function draw(wrong) {
    for (const tab of tabs) {
      setAttribute(tab, "aria-pressed", String(tab.dataset.panel === panel));
    }
    objects.hidden = panel !== "object";
    if (wrong) drawList(wrong);
    drawForm();
    body.toggleAttribute("inert", !session.canEdit);
    add.disabled = !session.canEdit;
    copy.disabled = drop.disabled = !session.canEdit || session.chosen === null;
  }
  function drawList(wrong) {
    const rows = session.document.objects.map(({ name }, n) => [
      name,
      n === session.chosen,
      wrong.has(n),
    ]);
    const text = JSON.stringify(rows);
    // A button must not be replaced while it is pressed.
    if (things.dataset.rows === text) return;
    const focused = [...things.children].indexOf(/** @type {Element} */ (document.activeElement));
    things.dataset.rows = text;
    things.replaceChildren(
      ...rows.map(([name, isChosen, isWrong], n) =>
        h("button", {
          type: "button",
          class: "small",
          "aria-pressed": String(isChosen),
          "data-wrong": isWrong,
          onclick: () => goTo(n),
          text: name || t("scene.nameless"),
        }),
      ),
    );
    if (focused >= 0) /** @type {HTMLElement} */ (things.children[focused])?.focus();
  }
  function drawForm() {
    const { attributes } = session.document;
    const names = attributes.map(({ name, values }) => [name, values.map((value) => value.name)]);
    const structure = attributes.map(({ values }) => values.length);
    // A form is made again if it has other fields.
    const key = JSON.stringify(panel === "words" ? structure : [session.chosen, names]) + panel;
    const isOther = form?.key !== key || formOf !== session.draft;
    if (!isOther) return form?.show();
    formOf = session.draft;
    form = { key, ...makeForm() };
    body.replaceChildren(form.element);
  }
  /** The draft that the form is of. @type {any} */
  let formOf = null;

  function makeForm() {
    const documentNow = () => session.document;
    const change = (f, what) => session.change(f, what);
    if (panel === "words") return wordsPanel(t, documentNow, change);
    const { chosen, object, document: scene } = session;
    if (chosen === null || !object) {
      const text = t(scene.objects.length === 0 ? "scene.empty" : "scene.none_chosen");
      return { element: h("p", { class: "empty", text }), show: () => {} };
    }
    return objectPanel(t, documentNow, chosen, { change, spot: () => session.placeOnTable() });
  }
  return { element, draw, go, show };
}
