// @ts-check
import { h, setText } from "../dom.js";
import { iconButton, textButton } from "./buttons.js";
import { freeName } from "./document.js";

/**
 * Which scene is edited, under which name it is saved, and whether the group uses it.
 * @param {any} t
 * @param {import("./session.js").SceneSession} session
 */
export function filesBar(t, session) {
  const select = h("select", {
    "aria-label": t("scene.which"),
    onchange: () => open(select.value),
  });
  const fresh = textButton(t("scene.new"), "plus", () => open(null));
  const undo = iconButton(t("scene.undo"), "undo", () => session.step("undo"));
  const redo = iconButton(t("scene.redo"), "redo", () => session.step("redo"));
  const name = h("input", {
    type: "text",
    autocomplete: "off",
    spellcheck: "false",
    required: true,
    pattern: "[A-Za-z0-9][A-Za-z0-9_\\-]{0,63}",
    "aria-label": t("scene.name"),
    title: t("scene.name"),
    oninput: () => draw(),
  });
  const save = h("button", { type: "button", class: "small", onclick: () => saveAs() });
  const use = h("button", { type: "button", class: "small primary", onclick: () => session.use() });
  const element = h("div", { class: "scene-files" }, select, fresh, undo, redo, name, save, use);
  setText(use, t("scene.use"));
  /** The draft whose name is shown. @type {any} */
  let named = null;
  let namedAs = null;

  function open(which) {
    const isLost = session.draft?.isChanged && !confirm(t("scene.discard"));
    if (isLost) draw();
    else session.open(which);
  }
  function saveAs() {
    if (session.canEdit && name.reportValidity()) session.save(name.value.trim());
  }

  function draw() {
    const { draft, listed, canEdit, findings } = session;
    if (draft !== named || draft?.name !== namedAs) {
      [named, namedAs] = [draft, draft?.name ?? null];
      const files = listed.names.map((one) => ({ name: one }));
      name.value = namedAs ?? freeName(files, "scene");
    }
    drawSelect(draft, listed);
    const n = findings.problems.length;
    setText(save, n > 0 ? t("scene.save_wrong", { n }) : t("scene.save"));
    const mayWrite = canEdit && !listed.locked;
    const isOther = name.value.trim() !== (draft?.name ?? "");
    save.disabled = !mayWrite || !(draft?.isChanged || isOther);
    const isInForce = draft?.hash === listed.in_force_hash;
    use.disabled = !mayWrite || draft === null || draft.isChanged || isInForce || n > 0;
    undo.disabled = !canEdit || !draft?.canUndo;
    redo.disabled = !canEdit || !draft?.canRedo;
    fresh.disabled = session.isBusy;
  }

  function drawSelect(draft, { names, in_force }) {
    const rows = names.map((one) => [
      one,
      one === in_force ? t("scene.in_force", { name: one }) : one,
    ]);
    if (draft && !names.includes(draft.name ?? "")) rows.unshift(["", t("scene.unsaved")]);
    const text = JSON.stringify(rows);
    if (select.dataset.rows !== text) {
      select.dataset.rows = text;
      select.replaceChildren(...rows.map(([value, words]) => h("option", { value, text: words })));
    }
    select.value = names.includes(draft?.name ?? "") ? (draft?.name ?? "") : "";
  }
  return { element, draw };
}
