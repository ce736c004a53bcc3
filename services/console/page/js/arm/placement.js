// @ts-check
/**
 * @typedef {{x: number, y: number, width: number, height: number}} Rect pixels; `x`, `y`: left upper corner
 *
 * @typedef {object} Wish of a label
 * @property {Rect} box of its object in the picture
 * @property {number} width of the label
 * @property {number} height
 * @property {number} weight the heavier goes first
 *
 * @typedef {object} Place of a label
 * @property {number} x left upper corner
 * @property {number} y
 * @property {[number, number, number, number]|null} leader from the label to its object; null: the
 *   label is next to it
 */

/** Space between a label and anything else. */
const GAP = 3;
/** Distances from its object at which a label is tried. */
const DISTANCES = [4, 16, 32, 52, 80, 116];
/** The sides of an object: of its box and of the label, -1 to 1, and the cost of each: above is best. */
const SIDES = [
  [0, -1, 0],
  [1, 0, 3],
  [-1, 0, 3],
  [0, 1, 4],
  [1, -1, 5],
  [-1, -1, 5],
  [1, 1, 7],
  [-1, 1, 7],
];
/** A label farther from its object has a leader. */
const ADJACENT = 9;
/** Cost of a place, in pixels of distance. */
const COST = {
  overLabel: 6_000,
  overNotice: 6_000,
  overObject: 3_000,
  crossing: 400,
  through: 120,
};
/** A place that costs as much covers something: others are tried all over the picture. */
const COVERS = COST.overObject;
/** Gain up to which a label does not move, so that it does not jump about. */
const STEADY = 14;
/** How often every label may choose again, knowing where the others went; once among very many. */
const SWEEPS = 3;
const MANY = 24;

/**
 * Places for labels, one for each: next to their objects, inside the frame, off each other, the objects
 * and the notices as far as there is room. A leader that crosses another, or a label over something, is
 * expensive and never forbidden, so that no label is left out.
 * @param {Wish[]} wishes
 * @param {{width: number, height: number}} frame
 * @param {Rect[]} [notices] that must stay readable
 * @param {(Place|null)[]} [before] the places so far
 * @returns {Place[]}
 */
export function placeLabels(wishes, frame, notices = [], before = []) {
  const boxes = wishes.map(({ box }) => within(box, frame));
  /** @type {(Place & Rect|null)[]} */
  const placed = wishes.map(() => null);
  const order = wishes.map((_, n) => n).sort((a, b) => wishes[b].weight - wishes[a].weight);
  const room = { boxes, frame, notices };
  const sweeps = wishes.length > MANY ? 1 : SWEEPS;
  for (let sweep = 0; sweep < sweeps; sweep++) {
    let isSettled = true;
    for (const n of order) {
      const others = placed.filter((place, k) => place !== null && k !== n);
      const next = best(n, wishes[n], before[n] ?? null, { ...room, others });
      if (next.x !== placed[n]?.x || next.y !== placed[n]?.y) isSettled = false;
      placed[n] = next;
    }
    if (isSettled) break;
  }
  return placed.map((place) => {
    const { x, y, leader } = /** @type {Place} */ (place);
    return { x, y, leader };
  });
}

/** The cheapest place of one label. */
function best(n, wish, before, room) {
  const near = cheapest(around(room.boxes[n], wish), n, wish, before, room);
  if (near.cost < COVERS) return near.place;
  const far = cheapest(everywhere(wish, room.frame), n, wish, before, room);
  return far.cost < near.cost ? far.place : near.place;
}

function cheapest(candidates, n, { width, height }, before, room) {
  let found = { cost: Number.POSITIVE_INFINITY, place: /** @type {any} */ (null) };
  for (const { x, y, extra } of candidates) {
    const label = inside(x, y, width, height, room.frame);
    const moved = before ? Math.hypot(label.x - before.x, label.y - before.y) : 0;
    const begin = extra + Math.min(moved, STEADY) + apart(label, room.boxes[n]);
    const covered = covers(label, room, begin, found.cost);
    if (covered >= found.cost) continue;
    const leader = leaderOf(label, room.boxes[n]);
    const cost = tangles({ ...label, leader }, n, room, covered, found.cost);
    if (cost < found.cost) found = { cost, place: { ...label, leader } };
  }
  return found;
}

function* around(box, { width, height }) {
  for (const distance of DISTANCES) {
    for (const [right, down, extra] of SIDES) {
      const x = box.x + box.width / 2 - width / 2 + right * (box.width / 2 + width / 2 + distance);
      const y =
        box.y + box.height / 2 - height / 2 + down * (box.height / 2 + height / 2 + distance);
      yield { x, y, extra };
    }
  }
}

function* everywhere({ width, height }, frame) {
  const across = Math.max(width / 2, 24);
  for (let y = GAP; y + height <= frame.height; y += height + GAP) {
    for (let x = GAP; x + width <= frame.width; x += across) yield { x, y, extra: 0 };
    yield { x: frame.width, y, extra: 0 };
  }
}

/** Adds the cost of things that a label covers to `cost`, up to `limit`. */
function covers(label, { boxes, others, notices }, begin, limit) {
  let cost = begin;
  for (const notice of notices) cost += covering(label, notice, COST.overNotice);
  for (let k = 0; k < others.length && cost < limit; k++) {
    cost += covering(label, others[k], COST.overLabel);
  }
  for (let k = 0; k < boxes.length && cost < limit; k++) {
    cost += covering(label, boxes[k], COST.overObject);
  }
  return cost;
}

/** What its leader, or another label's, passes through, added to `cost` likewise. */
function tangles(place, n, { boxes, others }, begin, limit) {
  const { leader } = place;
  let cost = begin;
  for (let k = 0; k < others.length && cost < limit; k++) {
    const other = others[k];
    if (other.leader && crosses(other.leader, place)) cost += COST.crossing;
    if (!leader) continue;
    if (crosses(leader, other)) cost += COST.crossing;
    if (other.leader && meet(leader, other.leader)) cost += COST.crossing;
  }
  for (let k = 0; leader && k < boxes.length && cost < limit; k++) {
    if (k !== n && crosses(leader, boxes[k])) cost += COST.through;
  }
  return cost;
}

function covering(label, other, price) {
  const wide = Math.min(label.x + label.width, other.x + other.width) - Math.max(label.x, other.x);
  const high =
    Math.min(label.y + label.height, other.y + other.height) - Math.max(label.y, other.y);
  if (wide <= -GAP || high <= -GAP) return 0;
  const share = ((wide + GAP) * (high + GAP)) / (label.width * label.height);
  return price * (1 + share);
}

/** The shortest distance between two rectangles. */
function apart(a, b) {
  const x = Math.max(a.x - b.x - b.width, b.x - a.x - a.width, 0);
  const y = Math.max(a.y - b.y - b.height, b.y - a.y - a.height, 0);
  return Math.hypot(x, y);
}

/** From the nearest point of a label to the inner part of its object. */
function leaderOf(label, box) {
  if (apart(label, box) <= ADJACENT) return null;
  const middle = { x: label.x + label.width / 2, y: label.y + label.height / 2 };
  const to = nearest(middle, inset(box));
  const from = nearest(to, label);
  return [from.x, from.y, to.x, to.y];
}

const inset = ({ x, y, width, height }) => ({
  x: x + 0.35 * width,
  y: y + 0.35 * height,
  width: 0.3 * width,
  height: 0.3 * height,
});

const nearest = ({ x, y }, rect) => ({
  x: Math.min(Math.max(x, rect.x), rect.x + rect.width),
  y: Math.min(Math.max(y, rect.y), rect.y + rect.height),
});

/** A label moved into the frame. */
function inside(left, top, width, height, frame) {
  const x = Math.min(Math.max(left, GAP), frame.width - width - GAP);
  const y = Math.min(Math.max(top, GAP), frame.height - height - GAP);
  return { x: Math.max(x, 0), y: Math.max(y, 0), width, height };
}

/** The part of an object's box that is in the frame; a point of its edge for one that is outside. */
function within({ x, y, width, height }, frame) {
  const [left, right] = [x, x + width].map((v) => Math.min(Math.max(v, 0), frame.width));
  const [top, bottom] = [y, y + height].map((v) => Math.min(Math.max(v, 0), frame.height));
  return { x: left, y: top, width: right - left, height: bottom - top };
}

/** Returns whether a line passes through a rectangle. */
function crosses([ax, ay, bx, by], { x, y, width, height }) {
  const isBeside =
    Math.max(ax, bx) <= x ||
    Math.min(ax, bx) >= x + width ||
    Math.max(ay, by) <= y ||
    Math.min(ay, by) >= y + height;
  if (isBeside) return false;
  // It passes unless all corners are on one side of it.
  const side = (px, py) => (bx - ax) * (py - ay) - (by - ay) * (px - ax);
  const [a, b] = [side(x, y), side(x + width, y)];
  const [c, d] = [side(x, y + height), side(x + width, y + height)];
  return Math.min(a, b, c, d) < 0 && Math.max(a, b, c, d) > 0;
}

/** Returns whether two lines cross. */
export function meet([ax, ay, bx, by], [cx, cy, dx, dy]) {
  const one = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
  const two = (bx - ax) * (dy - ay) - (by - ay) * (dx - ax);
  const three = (dx - cx) * (ay - cy) - (dy - cy) * (ax - cx);
  const four = (dx - cx) * (by - cy) - (dy - cy) * (bx - cx);
  return one * two < 0 && three * four < 0;
}
