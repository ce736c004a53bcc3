// @ts-check
/** Smallest size at which an object can be hit, pixels. */
const FINGER = 24;
/** A pointer that moves farther turns the picture and chooses nothing, pixels. */
const STILL = 6;

/** @typedef {import("./placement.js").Rect} Rect */

/**
 * Finds the object that a point of the picture belongs to: that of the label there, or else the one whose
 * middle is nearest among those that cover the point.
 * @param {{box: Rect, label: Rect|null}[]} targets
 * @param {{x: number, y: number}} point
 * @returns {number} its place among the targets, -1 for none
 */
export function objectAt(targets, point) {
  const named = targets.findIndex(({ label }) => label !== null && farness(label, point) <= 1);
  if (named >= 0) return named;
  let found = { n: -1, far: 1 };
  for (const [n, { box }] of targets.entries()) {
    const far = farness(atLeast(box, FINGER), point);
    if (far <= found.far) found = { n, far };
  }
  return found.n;
}

/** Distance of a point from a rectangle's middle: 1 at its edge. */
function farness({ x, y, width, height }, point) {
  const across = Math.abs(point.x - x - width / 2) / (width / 2);
  return Math.max(across, Math.abs(point.y - y - height / 2) / (height / 2));
}

function atLeast({ x, y, width, height }, size) {
  const [wide, high] = [Math.max(width, size), Math.max(height, size)];
  return { x: x - (wide - width) / 2, y: y - (high - height) / 2, width: wide, height: high };
}

/**
 * Reports which object the pointer is over, and which one is clicked; a drag is not a click.
 * @param {HTMLElement} canvas
 * @param {object} does
 * @param {(point: {x: number, y: number}) => number} does.find the object at a point, -1 for none
 * @param {(n: number) => void} does.hover
 * @param {(n: number) => void} does.choose
 */
export function watchPointing(canvas, { find, hover, choose }) {
  /** @type {{id: number, x: number, y: number}|null} */
  let pressed = null;
  const over = ({ offsetX, offsetY }) => find({ x: offsetX, y: offsetY });
  const isStill = ({ clientX, clientY }) =>
    pressed !== null && Math.hypot(clientX - pressed.x, clientY - pressed.y) <= STILL;

  canvas.addEventListener("pointermove", (event) => {
    if (pressed && !isStill(event)) pressed = null;
    hover(event.buttons === 0 ? over(event) : -1);
  });
  canvas.addEventListener("pointerleave", () => hover(-1));
  canvas.addEventListener("pointerdown", (event) => {
    const { pointerId: id, clientX: x, clientY: y } = event;
    pressed = event.button === 0 && event.isPrimary ? { id, x, y } : null;
  });
  canvas.addEventListener("pointercancel", () => {
    pressed = null;
  });
  canvas.addEventListener("pointerup", (event) => {
    const n = pressed?.id === event.pointerId && isStill(event) ? over(event) : -1;
    pressed = null;
    if (n >= 0) choose(n);
  });
}
