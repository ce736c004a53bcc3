// @ts-check
import { s } from "../dom.js";

const MICROPHONE =
  "M12 14.5a3 3 0 0 0 3-3v-5a3 3 0 0 0-6 0v5a3 3 0 0 0 3 3zM6 11.5a6 6 0 0 0 12 0M12 17.5v3M9 20.5h6";

/** A microphone in the colour of the text around it. @param {number} size pixels */
export function microphone(size) {
  const frame = { viewBox: "0 0 24 24", width: size, height: size, "aria-hidden": "true" };
  const path = { d: MICROPHONE, "stroke-linecap": "round", "stroke-linejoin": "round" };
  const line = { fill: "none", stroke: "currentColor", "stroke-width": 2 };
  return s("svg", { ...frame, ...line, class: "icon" }, s("path", path));
}
