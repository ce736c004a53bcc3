// @ts-check
/** Clearance below which two objects are in each other's way, metres. */
export const CLOSE_M = 0.02;

/**
 * @typedef {object} Thing an object of a scene document that has a place
 * @property {number[]} xyz centre, metres in frame `base`
 * @property {number[]} size extents along its own axes, metres
 * @property {number|null} [yaw] radians
 */

/** Returns whether an object can be drawn. @param {any} object @returns {boolean} */
export const isPlaced = (object) => Boolean(object?.xyz && object.size);

/**
 * The corners of an object's footprint, in order.
 * @param {Thing} thing
 * @returns {[number, number][]}
 */
export function corners({ xyz: [x, y], size: [long, wide], yaw }) {
  const [sin, cos] = [Math.sin(yaw ?? 0), Math.cos(yaw ?? 0)];
  const signs = [
    [1, 1],
    [-1, 1],
    [-1, -1],
    [1, -1],
  ];
  return signs.map(([a, b]) => {
    const [u, v] = [(a * long) / 2, (b * wide) / 2];
    return [x + u * cos - v * sin, y + u * sin + v * cos];
  });
}

/**
 * The clearance between two footprints and the place of the least; null if one object is above the other.
 * @param {Thing} a
 * @param {Thing} b
 * @returns {{gap: number, from: number[], to: number[]}|null} `gap` is 0 if they overlap
 */
export function clearance(a, b) {
  const apart = Math.abs(a.xyz[2] - b.xyz[2]) - (a.size[2] + b.size[2]) / 2;
  if (apart >= 0) return null;
  const [of, others] = [corners(a), corners(b)];
  if (overlap(of, others)) return { gap: 0, from: a.xyz.slice(0, 2), to: b.xyz.slice(0, 2) };
  let best = { gap: Number.POSITIVE_INFINITY, from: of[0], to: others[0] };
  const look = (point, [p, q], isOwn) => {
    const near = nearestOn(point, p, q);
    const gap = Math.hypot(point[0] - near[0], point[1] - near[1]);
    if (gap < best.gap) best = { gap, from: isOwn ? point : near, to: isOwn ? near : point };
  };
  for (const edge of edges(others)) for (const point of of) look(point, edge, true);
  for (const edge of edges(of)) for (const point of others) look(point, edge, false);
  return best;
}

/**
 * The object nearest to another one, at its height.
 * @param {any[]} objects of a scene document
 * @param {number} n
 * @returns {{other: number, gap: number, from: number[], to: number[]}|null}
 */
export function nearest(objects, n) {
  if (!isPlaced(objects[n])) return null;
  let best = null;
  for (const [other, object] of objects.entries()) {
    const found = other !== n && isPlaced(object) ? clearance(objects[n], object) : null;
    if (found && (best === null || found.gap < best.gap)) best = { other, ...found };
  }
  return best;
}

const edges = (points) => points.map((point, k) => [point, points[(k + 1) % points.length]]);

function nearestOn([x, y], [px, py], [qx, qy]) {
  const [dx, dy] = [qx - px, qy - py];
  const along = ((x - px) * dx + (y - py) * dy) / (dx * dx + dy * dy || 1);
  const part = Math.min(1, Math.max(0, along));
  return [px + part * dx, py + part * dy];
}

/** Two convex polygons overlap unless some edge has all of one beyond it. */
function overlap(a, b) {
  for (const [p, q] of [...edges(a), ...edges(b)]) {
    const axis = [q[1] - p[1], p[0] - q[0]];
    const range = (points) => {
      const along = points.map(([x, y]) => x * axis[0] + y * axis[1]);
      return [Math.min(...along), Math.max(...along)];
    };
    const [[low, high], [from, to]] = [range(a), range(b)];
    if (high <= from || to <= low) return false;
  }
  return true;
}
