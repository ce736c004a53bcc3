// @ts-check
/** Vertical field of view, degrees. */
export const FIELD_DEG = 32;

/**
 * Viewpoints of the scene: the direction from the scene to the eye.
 * @type {Record<string, [number, number, number]>}
 */
const DIRECTIONS = {
  start: [2.62, 1.25, 1.12],
  person: [2.9, 0, 0.95],
  above: [0.012, 0, 1],
};

/** Names of the views, the first is the one that the picture begins with. */
export const VIEWS = Object.keys(DIRECTIONS);

/**
 * @typedef {object} View
 * @property {[number, number, number]} eye metres in frame `base`
 * @property {[number, number, number]} target
 */

/**
 * From where everything between two corners is in the picture, and fills it.
 * @param {string} name one of `VIEWS`
 * @param {{low: number[], high: number[]}} box region that must be visible, metres
 * @param {number} aspect width over height of the picture
 * @returns {View}
 */
export function viewOf(name, { low, high }, aspect) {
  const direction = unit(DIRECTIONS[name] ?? DIRECTIONS.start);
  const right = unit(cross([0, 0, 1], direction));
  const up = cross(direction, right);
  const slope = Math.tan((FIELD_DEG * Math.PI) / 360);
  const slopes = [slope * aspect, slope];
  let target = low.map((value, k) => (value + high[k]) / 2);
  let distance = 1;
  // Nearer things look larger, so the middle of the picture is found in a few steps.
  for (let step = 0; step < 6; step++) {
    distance = Math.max(...corners(low, high).map((corner) => needed(corner, target)));
    const seen = corners(low, high).map((corner) => onto(corner, target, distance));
    const shift = [0, 1].map((k) => {
      const values = seen.map((point) => point[k]);
      return ((Math.min(...values) + Math.max(...values)) / 2) * slopes[k] * distance;
    });
    target = target.map((value, k) => value + right[k] * shift[0] + up[k] * shift[1]);
  }
  const eye = target.map((value, k) => value + direction[k] * distance);
  return { eye: /** @type {any} */ (eye), target: /** @type {any} */ (target) };

  /** Distance from which a corner is just seen. */
  function needed(corner, from) {
    const [x, y, ahead] = seenFrom(corner, from);
    return Math.max(Math.abs(x) / slopes[0], Math.abs(y) / slopes[1]) + ahead;
  }

  /** A corner's place in the picture, -1 to 1. */
  function onto(corner, from, far) {
    const [x, y, ahead] = seenFrom(corner, from);
    return [x / ((far - ahead) * slopes[0]), y / ((far - ahead) * slopes[1])];
  }

  function seenFrom(corner, from) {
    const way = corner.map((value, k) => value - from[k]);
    return [dot(way, right), dot(way, up), dot(way, direction)];
  }
}

/**
 * Points that must be in the picture: the objects and the robot's upper body and reach.
 * @param {{xyz: number[], size: number[]}[]} places of the objects
 * @param {{low: number[], high: number[]}} robot present bounds of the robot
 * @param {boolean} narrow whether the picture is higher than wide: then the robot's foot is left out
 */
export function boundsOf(places, robot, narrow = false) {
  const low = [...robot.low];
  const high = [...robot.high];
  for (const { xyz, size } of places) {
    for (const k of [0, 1, 2]) {
      low[k] = Math.min(low[k], xyz[k] - size[k] / 2);
      high[k] = Math.max(high[k], xyz[k] + size[k] / 2);
    }
  }
  const foot = places.length ? Math.min(...places.map(({ xyz }) => xyz[2])) : 0;
  low[2] = Math.max(low[2], foot - (narrow ? 0.1 : 0.22));
  // The region behind the robot's back needs no room.
  low[0] = Math.max(low[0], -0.2);
  return { low, high };
}

function corners(low, high) {
  const pick = (n) => [0, 1, 2].map((k) => ((n >> k) & 1 ? high[k] : low[k]));
  return Array.from({ length: 8 }, (_, n) => pick(n));
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
const unit = (a) => a.map((value) => value / Math.hypot(...a));
