// @ts-check
import { s } from "./dom.js";

/** Outlines of 24 × 24 units. */
const PATHS = {
  ear: "M7 9a5 5 0 0 1 10 0c0 3.4-3 4-3.6 6.6-.4 1.9-1.4 3.4-3.4 3.4-1.8 0-3-1.2-3-3M10 9.5a2.2 2.2 0 0 1 4.2-.8",
  speak: "M4 9.5v5h3.5L12 18V6L7.5 9.5zM15.5 9a4.2 4.2 0 0 1 0 6M18 6.5a7.8 7.8 0 0 1 0 11",
  think: "M6 12h.01M12 12h.01M18 12h.01",
  arm: "M5 20h7M8.5 20v-4.5M8.5 15.5 6 9l8-4 3.5 3M6 9a1.6 1.6 0 1 0 0-.1M17.5 8l3-.5M17.5 8l.5 3",
  stop: "M8.3 3.5h7.4l4.8 4.8v7.4l-4.8 4.8H8.3l-4.8-4.8V8.3zM9 12h6",
  down: "M12 3.5 21 19.5H3zM12 10v4.5M12 17.2v.01",
  person:
    "M12 11.5a3.7 3.7 0 1 0 0-7.4 3.7 3.7 0 0 0 0 7.4zM4.8 20c.6-3.8 3.5-5.7 7.2-5.7s6.6 1.9 7.2 5.7",
  eye: "M2.5 12S6 5.5 12 5.5 21.5 12 21.5 12 18 18.5 12 18.5 2.5 12 2.5 12zM12 14.8a2.8 2.8 0 1 0 0-5.6 2.8 2.8 0 0 0 0 5.6z",
  send: "M5 12h13M12.5 6l6 6-6 6",
  undo: "M5 9h9a5 5 0 0 1 0 10H8M8.5 5.5 5 9l3.5 3.5",
  again: "M19.5 12a7.5 7.5 0 1 1-2.4-5.5M17.5 2.5v4.3h-4.3",
  settings:
    "M4 7h8M17 7h3M4 17h3M12 17h8M14.5 9.5a2.5 2.5 0 1 0 0-5 2.5 2.5 0 0 0 0 5zM9.5 19.5a2.5 2.5 0 1 0 0-5 2.5 2.5 0 0 0 0 5z",
  history: "M4.5 12a7.5 7.5 0 1 1 2.3 5.4M4.5 18v-4.5H9M12 7.5V12l3 2",
  before: "M14.5 5.5 8 12l6.5 6.5",
  after: "M9.5 5.5 16 12l-6.5 6.5",
  help: "M9.2 9.2a2.9 2.9 0 1 1 4.3 2.5c-.9.5-1.5 1-1.5 2.1M12 17.2v.01M12 21a9 9 0 1 0 0-18 9 9 0 0 0 0 18z",
  hand: "M8 12V6.2a1.4 1.4 0 0 1 2.8 0V11M10.8 10.5V4.9a1.4 1.4 0 0 1 2.8 0V11M13.6 10.8V6.2a1.4 1.4 0 0 1 2.8 0v7.6c0 4-2.2 6.7-5.8 6.7-3 0-4.4-1.6-6.2-5.1-.9-1.8.9-3 2.2-1.6L8 15.5",
  link: "M10 14a4 4 0 0 0 5.7 0l3-3A4 4 0 0 0 13 5.3l-1 1M14 10a4 4 0 0 0-5.7 0l-3 3a4 4 0 0 0 5.7 5.7l1-1",
  save: "M12 4v11M7.5 11l4.5 4.5 4.5-4.5M4.5 19.5h15",
  check: "M5 12.5l4.5 4.5L19 7.5",
  play: "M8 5.5v13l10.5-6.5z",
  close: "M6 6l12 12M18 6 6 18",
  above: "M12 3.5v9M8.5 9 12 12.5 15.5 9M4 16.5h16M6.5 20.5h11",
  plus: "M12 5v14M5 12h14",
  copy: "M8.5 8.5h11v11h-11zM5 15.5v-11h11",
  redo: "M19 9h-9a5 5 0 0 0 0 10h6M15.5 5.5 19 9l-3.5 3.5",
  scene: "M3.5 5h17v14h-17zM7 8.5h4.5V13H7zM15 14h2.5v2.5H15z",
  wide: "M4 9V4h5M20 9V4h-5M4 15v5h5M20 15v5h-5",
};

/**
 * A small drawing in the colour of the text around it; hidden from screen readers.
 * @param {keyof typeof PATHS} name
 * @param {number} [size] pixels
 */
export function icon(name, size = 20) {
  const frame = { viewBox: "0 0 24 24", width: size, height: size, "aria-hidden": "true" };
  return s(
    "svg",
    { ...frame, class: "icon", fill: "none", stroke: "currentColor", "stroke-width": 2 },
    s("path", { d: PATHS[name], "stroke-linecap": "round", "stroke-linejoin": "round" }),
  );
}
