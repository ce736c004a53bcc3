import { thoughtsOf } from "../arm/words.js";
import { eachFrame, s, setAttribute, setText } from "../dom.js";
import { drawingOf } from "../model/drawing.js";
import { readable } from "../model/ranking.js";
import { drawObject } from "../views/drawing.js";
import { pressObject } from "../views/press.js";

// The picture is in millimetres, seen from above: the robot's x (forward) goes up, its y (left) to the left.
const VIEW = { left: -720, top: -1060, width: 1440, height: 1030 };
const UNITS = 1000;
/** Links of the arm as it is drawn, and its shoulder, which stands nearer than the robot's: the picture is less high so. */
const LINKS = [430, 400];
const SHOULDER = [0, -160];
/** Where the user stands, and what was handed over beside. */
const USER = [0, -975];
const WITH_USER_GAP = 130;
/** Smallest and largest picture of an object. */
const SIZE = [130, 200];
/** Room around the objects of one place: to the sides, up and down. */
const ZONE_PAD = [88, 105];
/** The gripper's height at which it is drawn in its own size, metres, and how much it grows above. */
const LEVEL = { z: 0.05, growth: 0.6 };
const FINGERS_CLOSED = ["closing", "holding", "returning"];
const PLACE = /^(in|on|at|under|inside|behind|near|by|next) /;

/**
 * The table from above: the objects with their belief, and the arm.
 * @param {HTMLElement} element
 * @param {{store: any, t: any}} context
 */
export function mountTable(element, context) {
  const { store, t } = context;
  const view = `${VIEW.left} ${VIEW.top} ${VIEW.width} ${VIEW.height}`;
  const picture = s("svg", { viewBox: view, role: "img", "aria-label": t("demo.picture") });
  const zones = s("g", { class: "zones" });
  const things = s("g", { class: "things" });
  const user = person(t("demo.you"));
  const arm = armOf(t("demo.robot"));
  picture.append(top(), zones, user, things, arm.node);
  element.append(picture);
  /** @type {{object: any, node: SVGElement, size: number}[]} */
  let all = [];
  let key = null;
  let flat = flattening([]);

  const draw = eachFrame(() => {
    const scene = store.get("scene");
    const world = store.get("world");
    if (!scene || !world) return;
    if (scene.key !== key) {
      key = scene.key;
      flat = flattening(scene.standing);
      all = scene.standing.map((object) => thing(object, scene, context));
      things.replaceChildren(...all.map(({ node }) => node));
      zones.replaceChildren(...zonesOf(scene, flat));
    }
    const now = store.get("now");
    const belief = store.get("belief") ?? store.get("dialogue")?.belief;
    const thoughts = thoughtsOf(belief, now.question, { ...scene, objects: scene.standing });
    let given = 0;
    all.forEach((one, index) => {
      const place = world.objects[index];
      const [x, y] = place ? flat(place) : [USER[0] + 150 + WITH_USER_GAP * given++, USER[1]];
      one.node.style.transform = `translate(${x}px, ${y}px)`;
      showThought(one, thoughts[index], t);
      setAttribute(one.node, "data-held", world.held === index);
      setAttribute(one.node, "data-given", place === null);
    });
    const [gripper] = world.grippers;
    arm.show(flat(gripper), gripper[2], store.get("arm"));
  });
  store.subscribe(["scene", "world", "arm", "dialogue", "belief", "now"], draw);
}

/** Where the middle of the objects is drawn, and how far to the side they may be. */
const MIDDLE = -640;
const ASIDE = 560;
/** How much they are drawn apart at most: to the side, and forward, where the user is. */
const APART_MAX = [1.7, 1.25];

/**
 * Places of a scene in the picture: objects that stand close together are drawn apart.
 * @param {{xyz: number[]|null}[]} objects
 * @returns {(xyz: number[]) => [number, number]} from metres, frame `base`
 */
function flattening(objects) {
  const places = objects.flatMap(({ xyz }) => (xyz ? [xyz] : []));
  const aside = Math.max(...places.map(([, y]) => Math.abs(y)), 0.1) * UNITS;
  const [sideways, onwards] = APART_MAX.map((most) => Math.min(most, Math.max(1, ASIDE / aside)));
  const forward = places.map(([x]) => x);
  const middle = places.length ? (Math.min(...forward) + Math.max(...forward)) / 2 : 0.6;
  return ([x, y]) => [-y * UNITS * sideways, MIDDLE - (x - middle) * UNITS * onwards];
}

function top() {
  return s("rect", { class: "table-top", x: -700, y: -885, width: 1400, height: 600, rx: 60 });
}

function person(words) {
  const [x, y] = USER;
  return s(
    "g",
    { class: "table-user", transform: `translate(${x} ${y})` },
    s("circle", { r: 62 }),
    s("text", { y: 16 }, words),
  );
}

/** One object: a glow as large as the belief, its drawing, the percentage. */
function thing(object, scene, context) {
  const longest = 1.15 * UNITS * Math.max(...(object.size ?? [0]));
  const size = Math.min(SIZE[1], Math.max(SIZE[0], longest));
  const drawn = drawObject(drawingOf(object, scene.noun));
  const frame = { x: -size / 2, y: -size / 2, width: size, height: size };
  for (const [name, value] of Object.entries(frame)) drawn.setAttribute(name, String(value));
  const node = s(
    "g",
    { class: "thing", onclick: () => pressObject(object, context) },
    s("title", {}, object.label),
    s("circle", { class: "thing-glow", r: size * 0.72 }),
    drawn,
    s("text", { class: "thing-share", y: size / 2 + 42 }),
  );
  return { object, node, size };
}

function showThought({ node }, { belief, best, asked }, t) {
  const { sign, share } = readable(belief ?? 0);
  setText(node.lastElementChild, sign + t.percent(share));
  node.style.setProperty("--belief", (belief ?? 0).toFixed(3));
  setAttribute(node, "data-best", best);
  setAttribute(node, "data-asked", asked);
}

/** The places that the scene names, around the objects that are there. */
function zonesOf(scene, flat) {
  const isPlace = ({ values }) => values.every(({ spoken }) => PLACE.test(spoken));
  const attribute = scene.attributes.find(isPlace);
  if (!attribute) return [];
  const placed = scene.standing.filter(({ xyz }) => xyz);
  const places = (objects) => objects.map(({ xyz }) => flat(xyz));
  const rows = range(places(placed), 1);
  return attribute.values.flatMap((value) => {
    const there = placed.filter(({ attributes }) => attributes[attribute.name] === value.name);
    return there.length > 0 ? [zone(range(places(there), 0), rows, value.spoken)] : [];
  });
}

/** The range of places along an axis of the picture, with room around them. */
function range(places, axis) {
  const all = places.map((place) => place[axis]);
  return [Math.min(...all) - ZONE_PAD[axis], Math.max(...all) + ZONE_PAD[axis]];
}

function zone([left, right], [upper, lower], words) {
  const box = { x: left, y: upper, width: right - left, height: lower - upper + 66, rx: 44 };
  return s(
    "g",
    { class: "zone" },
    s("rect", box),
    s("text", { x: (left + right) / 2, y: upper - 16 }, words),
  );
}

/** The robot and its arm: two links in the plane, and a gripper that grows with its height. */
function armOf(words) {
  const links = s("path", { class: "arm-links" });
  const core = s("path", { class: "arm-core" });
  const joint = s("circle", { class: "arm-joint", r: 26 });
  const fingers = [s("path", { class: "finger" }), s("path", { class: "finger" })];
  const gripper = s("g", { class: "gripper" }, s("circle", { r: 34 }), ...fingers);
  const body = s(
    "g",
    { class: "robot-body" },
    s("rect", { x: -150, y: -210, width: 300, height: 150, rx: 60 }),
    s("circle", { class: "robot-eye", cx: -52, cy: -110, r: 16 }),
    s("circle", { class: "robot-eye", cx: 52, cy: -110, r: 16 }),
    s("title", {}, words),
  );
  const node = s("g", { class: "robot-arm" }, body, links, core, joint, gripper);

  function show([x, y], height, arm) {
    const [ex, ey] = elbow(x, y);
    const path = `M${SHOULDER}L${ex.toFixed(1)} ${ey.toFixed(1)}L${x.toFixed(1)} ${y.toFixed(1)}`;
    links.setAttribute("d", path);
    core.setAttribute("d", path);
    joint.setAttribute("cx", ex.toFixed(1));
    joint.setAttribute("cy", ey.toFixed(1));
    const turn = (Math.atan2(y - ey, x - ex) * 180) / Math.PI + 90;
    const grown = 1 + LEVEL.growth * (height - LEVEL.z);
    gripper.setAttribute(
      "transform",
      `translate(${x.toFixed(1)} ${y.toFixed(1)}) rotate(${turn.toFixed(1)}) scale(${grown.toFixed(3)})`,
    );
    const open = FINGERS_CLOSED.includes(arm?.phase) ? 18 : 44;
    fingers.forEach((finger, i) => {
      const side = i === 0 ? -1 : 1;
      finger.setAttribute("d", `M${side * 22} -26L${side * open} -62L${side * open} -96`);
    });
    setAttribute(node, "data-stopped", arm?.stopped ?? false);
    setAttribute(node, "data-moving", arm?.moving ?? false);
  }
  return { node, show };
}

/** The elbow of two links from the shoulder to a place; stretched if it is too far. */
function elbow(x, y) {
  const [dx, dy] = [x - SHOULDER[0], y - SHOULDER[1]];
  const [a, b] = LINKS;
  const far = Math.max(1, Math.hypot(dx, dy));
  const along = (a * a - b * b + far * far) / (2 * far);
  const aside = Math.sqrt(Math.max(0, a * a - along * along));
  // Away from the middle, so that it does not cover the object.
  const side = x > 0 ? 1 : -1;
  return [
    SHOULDER[0] + (along * dx - side * aside * dy) / far,
    SHOULDER[1] + (along * dy + side * aside * dx) / far,
  ];
}
