// @ts-check
import { h } from "../dom.js";
import { answersOf } from "./model.js";

/**
 * The questionnaire.
 * @param {any[]} items
 * @param {(key: string, args?: object) => string} t
 * @param {(answers: Record<string, string|number>) => void} send
 * @returns {HTMLElement}
 */
export function questionnaire(items, t, send) {
  const note = h("p", { class: "study-note", role: "alert" });
  const submit = h("button", { type: "submit", class: "study-go", text: t("study.send") });
  const form = h(
    "form",
    { class: "study-form", novalidate: true },
    ...items.map((item) => question(item, t)),
    note,
    submit,
  );
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const given = new FormData(form);
    const value = (id) => /** @type {string|null} */ (given.get(id));
    const { answers, missing } = answersOf(items, value);
    for (const part of form.querySelectorAll("[data-item]")) {
      part.classList.toggle("missing-answer", missing.includes(part.getAttribute("data-item")));
    }
    note.textContent = missing.length > 0 ? t("study.missing", { n: missing.length }) : "";
    if (missing.length === 0) send(answers);
    else focusOn(form, missing[0]);
  });
  return form;
}

/** @param {HTMLFormElement} form @param {string} id */
function focusOn(form, id) {
  const field = form.querySelector(`[name="${id}"]`);
  field?.scrollIntoView({ block: "center" });
  if (field instanceof HTMLElement) field.focus({ preventScroll: true });
}

function question(item, t) {
  const open = item.required ? "" : ` ${t("study.optional")}`;
  if (item.kind === "likert") return scale(item, open);
  if (item.kind === "choice") return choice(item, open);
  const id = `item-${item.id}`;
  const field =
    item.kind === "text"
      ? h("textarea", { id, name: item.id, rows: 3, maxlength: 2000 })
      : h("input", { id, name: item.id, type: "text", inputmode: "decimal", autocomplete: "off" });
  return h(
    "div",
    { class: "study-item", "data-item": item.id },
    h("label", { for: id, text: item.text + open }),
    field,
  );
}

function scale(item, open) {
  const points = Array.from({ length: item.points }, (_, n) => String(n + 1));
  const end = { 1: item.low, [item.points]: item.high };
  const option = (point) => {
    const name = end[point] ? `${point}: ${end[point]}` : point;
    const radio = { type: "radio", name: item.id, value: point, "aria-label": name };
    return h("label", { class: "study-point" }, h("input", radio), h("span", { text: point }));
  };
  return h(
    "fieldset",
    { class: "study-item", "data-item": item.id },
    h("legend", { text: item.text + open }),
    h(
      "div",
      { class: "study-scale" },
      h("span", { class: "study-end", text: item.low ?? "", "aria-hidden": "true" }),
      h("div", { class: "study-points" }, ...points.map(option)),
      h("span", { class: "study-end", text: item.high ?? "", "aria-hidden": "true" }),
    ),
  );
}

function choice(item, open) {
  const option = (text) => {
    const radio = h("input", { type: "radio", name: item.id, value: text });
    return h("label", { class: "study-option" }, radio, h("span", { text }));
  };
  return h(
    "fieldset",
    { class: "study-item", "data-item": item.id },
    h("legend", { text: item.text + open }),
    h("div", { class: "study-options" }, ...item.options.map(option)),
  );
}
