// @ts-check
import { h } from "../dom.js";
import { icon } from "../icons.js";

/** A button with a drawing and words. @param {string} text @param {any} drawing @param {() => void} onclick */
export function textButton(text, drawing, onclick) {
  return h("button", { type: "button", class: "small", onclick }, icon(drawing, 18), text);
}

/** A button with a drawing alone. @param {string} label @param {any} drawing @param {() => void} onclick */
export function iconButton(label, drawing, onclick) {
  const about = { type: "button", class: "tool", "aria-label": label, title: label, onclick };
  return h("button", about, icon(drawing, 22));
}
