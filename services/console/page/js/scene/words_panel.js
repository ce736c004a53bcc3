// @ts-check
import { h, setText } from "../dom.js";
import { iconButton, textButton } from "./buttons.js";
import {
  addAttribute,
  addValue,
  removeAttribute,
  removeValue,
  renameAttribute,
  renameValue,
  toLines,
  toWords,
} from "./document.js";
import { fieldSet } from "./fields.js";

/**
 * The form of the words: the noun, the attributes with their values, and the wording of questions.
 * @param {any} t
 * @param {() => any} documentNow
 * @param {(f: (document: any) => void, what: string) => void} change
 * @returns {{element: HTMLElement, show: () => void, reveal: (k: number) => void}}
 */
export function wordsPanel(t, documentNow, change) {
  const fields = fieldSet(change);
  const noun = fields.text(
    t("scene.noun"),
    () => documentNow().noun,
    (document, text) => {
      document.noun = text.trim();
    },
    { required: true },
  );
  const attributes = documentNow().attributes.map((_, k) => attributeForm(k));
  const add = button("scene.attribute.add", "plus", addAttribute);
  const element = h("div", { class: "scene-form" }, noun, ...attributes, add);

  function button(key, drawing, f, what = {}) {
    return textButton(t(key, what), drawing, () => change(f, ""));
  }
  function attributeForm(k) {
    const own = () => documentNow().attributes[k] ?? { values: [], synonyms: [] };
    const to = (f) => (document, value) => f(document.attributes[k], value);
    const name = fields.text(
      t("scene.attribute.name"),
      () => own().name,
      (document, text) => renameAttribute(document, k, text.trim()),
      { required: true },
    );
    const synonyms = fields.text(
      t("scene.attribute.synonyms"),
      () => (own().synonyms ?? []).join(", "),
      to((attribute, text) => {
        attribute.synonyms = toWords(text);
      }),
    );
    const wording = (key) =>
      fields.lines(
        t(`scene.attribute.${key}`),
        () => (own()[key] ?? []).join("\n"),
        to((attribute, text) => {
          attribute[key] = toLines(text);
        }),
      );
    const values = own().values.map((value, v) => valueRow(k, v, value.name));
    const title = own().name;
    return h(
      "details",
      { class: "attribute", "data-n": k, open: true },
      h("summary", { text: title }),
      h("div", { class: "fields" }, name, synonyms),
      h("div", { class: "values" }, ...values),
      h(
        "div",
        { class: "row" },
        button("scene.value.add", "plus", (document) => addValue(document, k)),
        button("scene.attribute.remove", "close", (document) => removeAttribute(document, k), {
          name: title,
        }),
      ),
      h(
        "details",
        { class: "wording" },
        h("summary", { text: t("scene.attribute.wording") }),
        wording("ask_yes_no"),
        wording("ask_which"),
      ),
    );
  }
  function valueRow(k, v, title) {
    const own = () => documentNow().attributes[k]?.values[v] ?? {};
    const to = (f) => (document, value) => f(document.attributes[k].values[v], value);
    return h(
      "div",
      { class: "value-row" },
      fields.text(
        t("scene.value.name"),
        () => own().name,
        (document, text) => renameValue(document, k, v, text.trim()),
        { required: true },
      ),
      fields.text(
        t("scene.value.synonyms"),
        () => (own().synonyms ?? []).join(", "),
        to((value, text) => {
          value.synonyms = toWords(text);
        }),
      ),
      fields.text(
        t("scene.value.spoken"),
        () => own().spoken ?? "",
        to((value, text) => {
          value.spoken = text.trim() || null;
        }),
        { placeholder: own().name },
      ),
      iconButton(t("scene.value.remove", { name: title }), "close", () =>
        change((document) => removeValue(document, k, v), ""),
      ),
    );
  }
  /** Brings an attribute into sight. @param {number} k */
  function reveal(k) {
    const form = element.querySelector(`.attribute[data-n="${k}"]`);
    if (!(form instanceof HTMLDetailsElement)) return;
    form.open = true;
    form.scrollIntoView({ block: "nearest" });
    form.querySelector("input")?.focus();
  }
  function show() {
    fields.show();
    for (const [k, form] of attributes.entries()) {
      setText(/** @type {Node} */ (form.firstChild), documentNow().attributes[k]?.name ?? "");
    }
  }
  show();
  return { element, show, reveal };
}
