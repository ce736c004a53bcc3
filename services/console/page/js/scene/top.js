// @ts-check
import { boardsUnder } from "../arm/boards.js";
import { h, keyed, s, setAttribute, setText } from "../dom.js";
import { drawingOf } from "../model/drawing.js";
import { moveBy, toMillimetre, turnTo } from "./document.js";
import { CLOSE_M, isPlaced, nearest } from "./geometry.js";

/** Least region of the picture, metres: x from, to, y from, to. */
const VIEW_M = [-0.3, 1.25, -1.05, 1.05];
/** Margin around objects that stand farther away, metres. */
const MARGIN_M = 0.2;
/** Distance of the handle that turns an object from its edge, millimetres. */
const HANDLE_MM = 60;
/** Steps of the keys, metres and radians. */
const STEP_M = { usual: 0.01, fine: 0.001 };
const TURN = Math.PI / 12;
const SNAP = Math.PI / 36;
/** Directions of the keys, as the picture shows them: forward is up, the robot's left is left. */
const KEYS = { ArrowUp: [1, 0], ArrowDown: [-1, 0], ArrowLeft: [0, 1], ArrowRight: [0, -1] };

/** A point of frame `base` in the picture, millimetres. @param {number[]} point */
const on = ([x, y]) => [-y * 1e3, -x * 1e3];

/**
 * The table from above, in frame `base`: the robot at its place, objects to size, the reach of the chosen one.
 * @param {any} t
 * @param {object} does
 * @param {(n: number) => void} does.choose
 * @param {(n: number, change: (object: any) => void, what: string) => void} does.change
 * @param {() => void} does.settle a movement begins or has ended
 */
export function topView(t, { choose, change, settle }) {
  const layers = Object.fromEntries(
    ["grid", "boards", "reach", "robot", "things", "gap", "handle"].map((name) => [
      name,
      s("g", { class: `top-${name}` }),
    ]),
  );
  const svg = s("svg", { class: "table-top", role: "group", "aria-label": t("scene.top") });
  svg.append(...Object.values(layers));
  const element = h("div", { class: "top-frame" }, svg);
  /** @type {any} the last drawing */
  let shown = null;
  /** @type {{n: number, turns: boolean, dx: number, dy: number}|null} */
  let drag = null;

  svg.addEventListener("pointerdown", (event) => {
    const target = /** @type {Element} */ (event.target);
    const turns = target.closest(".top-handle") !== null;
    const thing = target.closest(".thing");
    if (event.button !== 0 || (!turns && !thing)) return;
    const n = turns ? shown.chosen : Number(thing?.getAttribute("data-n"));
    if (!turns) choose(n);
    if (!shown.canEdit) return;
    const [x, y] = at(event);
    const [ox, oy] = shown.document.objects[n].xyz;
    drag = { n, turns, dx: ox - x, dy: oy - y };
    // Earlier moves by keys are undone separately.
    settle();
    svg.setPointerCapture(event.pointerId);
    setAttribute(svg, "data-drag", true);
    event.preventDefault();
    if (thing instanceof SVGElement) thing.focus({ preventScroll: true });
  });
  svg.addEventListener("pointermove", (event) => {
    if (!drag) return;
    const { n, turns, dx, dy } = drag;
    const [x, y] = at(event);
    if (!turns) {
      const to = inView(x + dx, y + dy).map(toMillimetre);
      change(n, (object) => object.xyz.splice(0, 2, ...to), `move ${n}`);
      return;
    }
    const [ox, oy] = shown.document.objects[n].xyz;
    const angle = Math.atan2(y - oy, x - ox);
    const snapped = event.shiftKey ? angle : Math.round(angle / SNAP) * SNAP;
    change(n, (object) => turnTo(object, snapped), `turn ${n}`);
  });
  const end = () => {
    if (!drag) return;
    drag = null;
    setAttribute(svg, "data-drag", null);
    settle();
  };
  svg.addEventListener("pointerup", end);
  svg.addEventListener("pointercancel", end);
  svg.addEventListener("keydown", (event) => {
    const thing = /** @type {Element} */ (event.target).closest(".thing");
    if (!thing || event.ctrlKey || event.metaKey || event.altKey) return;
    if (onKey(event, Number(thing.getAttribute("data-n")))) event.preventDefault();
  });
  svg.addEventListener("focusin", (event) => {
    const thing = /** @type {Element} */ (event.target).closest(".thing");
    if (thing) choose(Number(thing.getAttribute("data-n")));
  });

  function onKey(event, n) {
    const direction = KEYS[event.key];
    if (event.key === "Enter" || event.key === " ") choose(n);
    else if (!shown.canEdit) return false;
    else if (direction) {
      const step = event.shiftKey ? STEP_M.fine : STEP_M.usual;
      const [dx, dy] = direction.map((sign) => sign * step);
      change(n, (object) => moveBy(object, dx, dy), `move ${n}`);
    } else if (event.key.toLowerCase() === "r") {
      const by = event.shiftKey ? -TURN : TURN;
      change(n, (object) => turnTo(object, (object.yaw ?? 0) + by), `turn ${n}`);
    } else return false;
    return true;
  }

  /** Place of an event, metres in frame `base`. */
  function at(event) {
    const matrix = /** @type {SVGSVGElement} */ (svg).getScreenCTM()?.inverse();
    const point = new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix);
    return [-point.y / 1e3, -point.x / 1e3];
  }

  /** The place in the picture that is nearest to one, metres. */
  function inView(x, y) {
    const { viewBox } = /** @type {SVGSVGElement} */ (svg);
    const { x: left, y: above, width, height } = viewBox.baseVal;
    const clamp = (m, low, high) => Math.min(Math.max(m, low / 1e3), high / 1e3);
    return [clamp(x, -above - height, -above), clamp(y, -left - width, -left)];
  }

  /**
   * @param {object} what
   * @param {any} what.document
   * @param {any} what.robot
   * @param {number|null} what.chosen
   * @param {import("./reach.js").ReachMap|null} what.reach of the chosen object
   * @param {Set<number>} what.wrong objects with a problem
   * @param {boolean} what.canEdit
   */
  function draw(what) {
    shown = what;
    const { document, robot, chosen, reach, wrong, canEdit } = what;
    const placed = [...document.objects.entries()].filter(([, object]) => isPlaced(object));
    // While something is dragged the picture does not move.
    if (!drag) drawGrid(placed.map(([, object]) => object));
    drawBoards(placed.map(([, object]) => object));
    drawReach(reach);
    drawRobot(robot);
    const near = chosen === null ? null : nearest(document.objects, chosen);
    drawGap(near);
    keyed(
      layers.things,
      placed,
      ([n]) => n,
      ([n]) => thingNode(n),
      (node, [n, object]) => {
        const isChosen = n === chosen;
        const limb = isChosen ? reach?.at(object.xyz[0], object.xyz[1]) : undefined;
        const isOver = isChosen && near !== null && near.gap === 0;
        fillThing(node, object, document.noun, t);
        setAttribute(node, "aria-pressed", String(isChosen));
        setAttribute(node, "data-reach", limb === undefined ? null : limb === null ? "no" : "yes");
        setAttribute(node, "data-wrong", wrong.has(n) || isOver);
      },
    );
    drawHandle(canEdit && chosen !== null ? document.objects[chosen] : null);
  }

  function drawGrid(objects) {
    const view = [...VIEW_M];
    for (const { xyz } of objects) {
      for (const k of [0, 1]) {
        view[2 * k] = Math.min(view[2 * k], xyz[k] - MARGIN_M);
        view[2 * k + 1] = Math.max(view[2 * k + 1], xyz[k] + MARGIN_M);
      }
    }
    const [fromX, toX, fromY, toY] = view;
    const box = [-toY, -toX, toY - fromY, toX - fromX].map((m) => Math.round(m * 1e3)).join(" ");
    if (svg.getAttribute("viewBox") === box) return;
    svg.setAttribute("viewBox", box);
    const lines = [];
    const line = (from, to, m) => {
      const [[x1, y1], [x2, y2]] = [on(from), on(to)];
      const isHalf = Math.abs(m * 2 - Math.round(m * 2)) < 1e-6;
      lines.push(s("line", { x1, y1, x2, y2, "data-half": isHalf }));
    };
    const tenths = (from, to) => {
      const all = [];
      for (let n = Math.ceil(from * 10); n <= to * 10; n++) all.push(n / 10);
      return all;
    };
    for (const x of tenths(fromX, toX)) line([x, fromY], [x, toY], x);
    for (const y of tenths(fromY, toY)) line([fromX, y], [toX, y], y);
    for (const x of tenths(fromX, toX).filter((m) => m > 0 && Number.isInteger(m * 2))) {
      const [px, py] = on([x, toY]);
      lines.push(s("text", { x: px + 12, y: py - 10 }, t("scene.metres", { m: t.number(x) })));
    }
    layers.grid.replaceChildren(...lines);
  }

  function drawBoards(objects) {
    const boards = boardsUnder(objects.map((object) => ({ ...object, yaw: object.yaw ?? 0 })));
    layers.boards.replaceChildren(
      ...boards.map(({ low, high }) => {
        const [x, y] = on(high);
        const [width, height] = [(high[1] - low[1]) * 1e3, (high[0] - low[0]) * 1e3];
        return s("rect", { x, y, width, height, rx: 18 });
      }),
    );
  }

  let reachDrawn = "";
  function drawReach(reach) {
    const stretches = reach?.stretches() ?? [];
    const path = (limb) =>
      stretches
        .filter((stretch) => stretch.limb === limb)
        .map(({ x, from, to }) => {
          const [px, py] = on([x + 0.025, to]);
          const wide = (to - from) * 1e3;
          return `M${px.toFixed(0)} ${py.toFixed(0)}h${wide.toFixed(0)}v50h${(-wide).toFixed(0)}z`;
        })
        .join("");
    const limbs = [...new Set(stretches.map(({ limb }) => limb))].filter((limb) => limb !== null);
    const drawn = limbs.map((limb, k) => ({ d: path(limb), "data-limb": k }));
    const text = JSON.stringify(drawn);
    if (text === reachDrawn) return;
    reachDrawn = text;
    layers.reach.replaceChildren(...drawn.map((one) => s("path", one)));
  }

  let robotDrawn = null;
  function drawRobot(robot) {
    if (robotDrawn === robot) return;
    robotDrawn = robot;
    const shoulders = robot.limbs.map(({ shoulder_xyz_m }) => on(shoulder_xyz_m));
    const [hx, hy] = on(robot.hand_over_xyz_m);
    layers.robot.replaceChildren(
      s("circle", { class: "top-base", r: 130 }),
      s("path", { class: "top-front", d: "M-34 -96L0 -124L34 -96" }),
      ...shoulders.map(([cx, cy]) => s("circle", { class: "top-shoulder", cx, cy, r: 55 })),
      s("text", { class: "top-name", y: 14, "text-anchor": "middle" }, robot.name),
      s("circle", { class: "top-hand", cx: hx, cy: hy, r: 26 }),
      s("text", { class: "top-note", x: hx + 38, y: hy + 11 }, t("scene.hand_over")),
    );
  }

  function drawGap(near) {
    if (!near || near.gap === 0 || near.gap > 0.3) return layers.gap.replaceChildren();
    const [[x1, y1], [x2, y2]] = [on(near.from), on(near.to)];
    const words = t("scene.mm", { mm: Math.round(near.gap * 1e3) });
    const place = { x: (x1 + x2) / 2 + 12, y: (y1 + y2) / 2 - 10 };
    const close = { "data-close": near.gap < CLOSE_M };
    layers.gap.replaceChildren(s("line", { x1, y1, x2, y2, ...close }), s("text", place, words));
  }

  function drawHandle(object) {
    if (!isPlaced(object)) return layers.handle.replaceChildren();
    const [x, y] = on(object.xyz);
    const radius = (object.size[0] / 2) * 1e3 + HANDLE_MM;
    const move = `translate(${x} ${y}) rotate(${(-(object.yaw ?? 0) * 180) / Math.PI})`;
    const edge = (object.size[0] / 2) * 1e3;
    const handle = s(
      "g",
      { transform: move },
      s("line", { x1: 0, y1: -edge, x2: 0, y2: -radius }),
      s("circle", { cx: 0, cy: -radius, r: 20 }, s("title", {}, t("scene.turn"))),
    );
    layers.handle.replaceChildren(handle);
  }

  /** Brings the focus to an object. @param {number} n */
  function focus(n) {
    const thing = layers.things.querySelector(`[data-n="${n}"]`);
    if (thing instanceof SVGElement) thing.focus({ preventScroll: true });
  }
  return { element, draw, focus };
}

function thingNode(n) {
  const body = s("g", { class: "thing-body" }, s("rect", {}), s("rect", { class: "thing-inside" }));
  const label = s("text", { "text-anchor": "middle" });
  const about = { class: "thing", tabindex: 0, role: "button", "data-n": n };
  return s("g", about, body, label);
}

function fillThing(node, object, noun, t) {
  const [body, label] = node.children;
  const [x, y] = on(object.xyz);
  const [height, width] = object.size.map((m) => m * 1e3);
  const { fill, outline } = drawingOf(object, noun);
  setAttribute(node, "transform", `translate(${x} ${y})`);
  setAttribute(node, "data-name", object.name);
  const degrees = ((object.yaw ?? 0) * 180) / Math.PI;
  setAttribute(body, "transform", `rotate(${-degrees})`);
  const isHollow = object.form === "hollow";
  // Hollow objects as long as wide are mostly round.
  const isRound = isHollow && Math.abs(width - height) < 1;
  const [outer, inner] = body.children;
  rectangle(outer, width, height, isRound ? width / 2 : 6);
  const [w, hh] = [width - 14, height - 14].map((mm) => Math.max(mm, 0));
  rectangle(inner, isHollow ? w : 0, isHollow ? hh : 0, isRound ? w / 2 : 4);
  for (const part of [outer, inner]) {
    setAttribute(part, "fill", fill);
    setAttribute(part, "stroke", outline);
  }
  const [sin, cos] = [Math.abs(Math.sin(object.yaw ?? 0)), Math.abs(Math.cos(object.yaw ?? 0))];
  setAttribute(label, "y", ((height * cos + width * sin) / 2 + 36).toFixed(0));
  setText(label, object.name);
  const [cmX, cmY] = object.xyz.map((m) => t.number(m * 100, { maximumFractionDigits: 1 }));
  setAttribute(node, "aria-label", t("scene.thing", { name: object.name, x: cmX, y: cmY }));
}

function rectangle(node, width, height, rx) {
  const about = { x: -width / 2, y: -height / 2, width, height, rx };
  for (const [name, value] of Object.entries(about)) setAttribute(node, name, value);
}
