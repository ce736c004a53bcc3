// @ts-check
import { s } from "../dom.js";

/**
 * The parts of each form in a square of 64 units: `[path, paint]`, where paint is `body`, `inside`
 * (seen into), `line` (outline only), `metal` or `dark`.
 * @type {Record<string, [string, string][]>}
 */
const FORMS = {
  bowl: [
    ["M6 24c0 17 9 28 20 28h12c11 0 20-11 20-28z", "body"],
    ["M6 24a26 7 0 1 0 52 0a26 7 0 1 0-52 0z", "inside"],
    ["M24 52h16v3H24z", "body"],
  ],
  cup: [
    ["M44 26h6c8 0 8 18-2 18h-5", "line"],
    ["M12 18l3 32c.4 4 3 6 7 6h14c4 0 6.6-2 7-6l3-32z", "body"],
    ["M12 18a17 5 0 1 0 34 0a17 5 0 1 0-34 0z", "inside"],
  ],
  glass: [
    ["M16 12l4 42c.2 2 2 3 4 3h16c2 0 3.8-1 4-3l4-42z", "body"],
    ["M16 12a16 5 0 1 0 32 0a16 5 0 1 0-32 0z", "inside"],
  ],
  plate: [
    ["M4 34a28 12 0 1 0 56 0a28 12 0 1 0-56 0z", "body"],
    ["M14 33a18 7 0 1 0 36 0a18 7 0 1 0-36 0z", "inside"],
  ],
  bottle: [
    ["M27 6h10v12c0 4 9 6 9 16v20c0 3-2 4-4 4H22c-2 0-4-1-4-4V34c0-10 9-12 9-16z", "body"],
    ["M26 4h12v6H26z", "dark"],
  ],
  can: [
    ["M14 14v36a18 6 0 0 0 36 0V14z", "body"],
    ["M14 14a18 6 0 1 0 36 0a18 6 0 1 0-36 0z", "inside"],
  ],
  box: [
    ["M8 22l24-11 24 11-24 11z", "inside"],
    ["M8 22l24 11v22L8 44z", "body"],
    ["M56 22L32 33v22l24-11z", "body"],
  ],
  book: [
    ["M12 10h32c5 0 8 2 8 6v38H18c-4 0-6-2-6-6z", "body"],
    ["M14 47h38v7H18c-3 0-5-2-4-7z", "inside"],
  ],
  ball: [
    ["M8 32a24 24 0 1 0 48 0a24 24 0 1 0-48 0z", "body"],
    ["M18 25c2-6 7-9 12-9", "line"],
  ],
  rod: [["M6 50l40-40 8 8-40 40z", "body"]],
  pen: [
    ["M14 44l30-30 6 6-30 30z", "body"],
    ["M14 44l6 6-12 6z", "metal"],
    ["M44 14l5-5 6 6-5 5z", "dark"],
  ],
  marker: [
    ["M16 40l24-24 10 10-24 24z", "body"],
    ["M12 46l4-6 10 10-6 4z", "inside"],
    ["M12 46l8 8-11 2z", "dark"],
    ["M40 16l6-6c2-2 4-2 6 0l4 4c2 2 2 4 0 6l-6 6z", "body"],
  ],
  screwdriver: [
    ["M8 54l22-22 4 4-22 22-5 1z", "metal"],
    ["M30 28l4-5 13-13c4-4 14 5 10 9L43 32l-5 4z", "body"],
  ],
  wrench: [
    [
      "M38 8c7-2 11-1 11-1l-7 8 1 7 7 1 7-8s2 5 0 10c-2 6-8 8-14 7L24 51c0 0 0 0 0 0c-3 8-11 9-16 6l7-7-2-4-5-1-5 5s-1-8 6-11c3-2 7-2 9-1l19-18c-2-5-1-10 1-12z",
      "body",
    ],
  ],
  hammer: [
    ["M29 24h7v34c0 2-7 2-7 0z", "inside"],
    ["M12 10h32c6 0 9 4 10 8l-10-1v7H12z", "body"],
  ],
  spoon: [
    ["M30 28h5v30c0 2-5 2-5 0z", "body"],
    ["M22 17a10.5 13 0 1 0 21 0a10.5 13 0 1 0-21 0z", "body"],
  ],
  fork: [["M22 6v16c0 6 4 8 7 9v27c0 2 6 2 6 0V31c3-1 7-3 7-9V6h-3v15h-4V6h-6v15h-4V6z", "body"]],
};

/**
 * Draws an object.
 * @param {import("../model/drawing.js").Drawing} drawing
 * @returns {SVGElement}
 */
export function drawObject({ form, fill, outline, finish, scale }) {
  const frame = { viewBox: "0 0 64 64", class: `drawing drawing-${finish}`, "aria-hidden": "true" };
  const inset = 32 * (1 - scale);
  const paints = {
    body: { fill },
    inside: { fill, "data-light": true },
    line: { fill: "none", "stroke-width": 4 },
    metal: { fill: "#c3c9cf" },
    dark: { fill: "#3a3d42" },
  };
  const parts = (FORMS[form] ?? FORMS.box).map(([d, paint]) =>
    s("path", { d: d, ...paints[paint], class: `part-${paint}` }),
  );
  const style = {
    stroke: outline,
    "stroke-width": 2,
    "stroke-linejoin": "round",
    "stroke-linecap": "round",
  };
  const shine =
    finish === "plain" ? null : s("path", { d: SHINE[form] ?? SHINE.any, class: "shine" });
  const move = `translate(${inset} ${inset * 1.5}) scale(${scale})`;
  return s("svg", frame, s("g", { ...style, transform: move }, ...parts, shine));
}

/** A streak of light on glass or metal. */
const SHINE = {
  bowl: "M14 33c2 7 5 11 8 13",
  ball: "M15 30c1-7 6-12 12-13",
  box: "M13 28l14 6",
  wrench: "M22 46l22-22",
  any: "M22 26v22",
};
