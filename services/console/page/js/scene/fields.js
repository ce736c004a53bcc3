// @ts-check
import { h } from "../dom.js";

/**
 * Fields of a form that follow a document. Input is adopted when it is complete; what changes
 * elsewhere comes into the fields that are not being typed in.
 * @param {(change: (document: any) => void, what: string) => void} change
 */
export function fieldSet(change) {
  /** @type {{node: any, read: () => string|boolean, property: "value"|"checked"}[]} */
  const all = [];
  let count = 0;

  function add(node, read, write, property = /** @type {"value"|"checked"} */ ("value")) {
    const what = `field ${count++}`;
    const event = node.tagName === "SELECT" || property === "checked" ? "change" : "input";
    node.addEventListener(event, () => {
      if (node.validity && !node.validity.valid) return;
      change((document) => write(document, node[property]), what);
    });
    // Invalid input does not stay in the field.
    node.addEventListener("blur", () => show());
    all.push({ node, read, property });
    return node;
  }

  /** A line of text. */
  function text(label, read, write, more = {}) {
    const node = h("input", { type: "text", autocomplete: "off", spellcheck: "false", ...more });
    return labelled(label, add(node, read, write));
  }

  /** Lines of text. */
  function lines(label, read, write) {
    const node = h("textarea", { rows: 2, spellcheck: "true" });
    return labelled(label, add(node, read, write));
  }

  /**
   * A number in a unit of its own; empty if it is null and may be.
   * @param {string} label
   * @param {object} about
   * @param {string} about.unit
   * @param {number} about.scale units of the form in one of the file
   * @param {() => number|null|undefined} about.read
   * @param {(document: any, value: number|null) => void} about.write
   * @param {Record<string, any>} [about.more] attributes
   */
  function number(label, { unit, scale, read, write, more = {} }) {
    const node = h("input", { type: "number", inputmode: "decimal", step: "any", ...more });
    const digits = (value) => String(Math.round(value * scale * 1e4) / 1e4);
    const take = (document, typed) => {
      if (typed === "" && more.required) return;
      write(document, typed === "" ? null : Math.round((Number(typed) / scale) * 1e6) / 1e6);
    };
    const shown = () => {
      const value = read();
      return value === null || value === undefined ? "" : digits(value);
    };
    return labelled(label, add(node, shown, take), unit);
  }

  /** A choice. @param {[string, string][]} options value and words */
  function choice(label, options, read, write) {
    const nodes = options.map(([value, words]) => h("option", { value, text: words }));
    return labelled(label, add(h("select", {}, ...nodes), read, write));
  }

  function box(label, read, write) {
    const node = h("input", { type: "checkbox" });
    add(node, read, write, "checked");
    return h("label", { class: "settings-box" }, node, h("span", { text: label }));
  }

  /** Brings the fields up to the document. */
  function show() {
    for (const { node, read, property } of all) {
      const isTyped = node === document.activeElement && node.matches("input, textarea");
      const value = read();
      if (node[property] === value) continue;
      // A number that is being typed has other forms: "0." on the way to "0.5".
      const isSame = node.type === "number" && Number(node.value) === Number(value);
      if (isTyped && (isSame || property === "value")) continue;
      node[property] = value;
    }
  }
  return { text, lines, number, choice, box, show };
}

function labelled(words, node, unit = "") {
  const name = h("span", { class: "field-name", text: words });
  const mark = unit ? h("span", { class: "field-unit", text: unit }) : null;
  return h("label", { class: "field" }, name, h("span", { class: "field-box" }, node, mark));
}
