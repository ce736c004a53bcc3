// @ts-check
// Changes of a scene document. Each returns a new one, or changes the one that `Draft.change` has copied.
import { CLOSE_M, clearance, isPlaced } from "./geometry.js";

/** Spacing of the places that are tried for a new object, metres, and how far they reach. */
const SPOT_M = 0.05;
const SPOTS = 16;
/** Clearances that are tried for a new object one after the other, metres. */
const LOOSE_M = [0.08, 0.05, CLOSE_M];
/** Defaults of a new object without another one as a model. */
const PLAIN = { attributes: {}, size: [0.1, 0.03, 0.05], grasp_width: 0.03 };

/** Rounds metres to tenths of a millimetre: a file has no longer numbers. @param {number} m */
export const rounded = (m) => Math.round(m * 1e4) / 1e4 + 0;

/** Rounds a place to millimetres. @param {number} m */
export const toMillimetre = (m) => Math.round(m * 1e3) / 1e3 + 0;

/** "navy, dark blue" as a list. @param {string} text */
export const toWords = (text) =>
  text
    .split(",")
    .map((word) => word.trim())
    .filter(Boolean);

/** Lines as a list. @param {string} text */
export const toLines = (text) =>
  text
    .split("\n")
    .map((line) => line.trim())
    .filter(Boolean);

/**
 * A name that no other object has: `cup`, `cup_2` …
 * @param {{name: string}[]} others
 * @param {string} wished
 */
export function freeName(others, wished) {
  const base = wished.replace(/_\d+$/, "") || "object";
  const taken = new Set(others.map(({ name }) => name));
  if (!taken.has(wished) && wished) return wished;
  for (let n = 2; ; n++) if (!taken.has(`${base}_${n}`)) return `${base}_${n}`;
}

/**
 * Adds an object like the one at `like`, or a plain one. Returns its number.
 * @param {any} document
 * @param {number|null} like
 * @param {{spot: (size: number[], z: number) => [number, number], table_z_m: number}} room
 */
export function addObject(document, like, { spot, table_z_m }) {
  const model = like === null ? null : document.objects[like];
  const object = structuredClone({ ...PLAIN, ...(model ?? {}) });
  object.from = null;
  object.name = freeName(document.objects, model ? model.name : "object");
  object.size ??= [...PLAIN.size];
  object.grasp_width ??= PLAIN.grasp_width;
  const z = isPlaced(model) ? model.xyz[2] : rounded(table_z_m + object.size[2] / 2);
  object.xyz = [...spot(object.size, z), z];
  const n = like === null ? document.objects.length : like + 1;
  document.objects.splice(n, 0, object);
  return n;
}

/**
 * The free place nearest to the middle of the arm's reach.
 * @param {any[]} objects
 * @param {number[]} size of the new one
 * @param {number} z of its centre
 * @param {{middle: [number, number], reaches: (x: number, y: number) => boolean}} arm
 * @returns {[number, number]}
 */
export function freeSpot(objects, size, z, { middle, reaches }) {
  const spots = [];
  for (let i = -SPOTS; i <= SPOTS; i++) {
    for (let k = -SPOTS; k <= SPOTS; k++) spots.push([i * SPOT_M, k * SPOT_M]);
  }
  spots.sort((a, b) => Math.hypot(...a) - Math.hypot(...b));
  const placed = objects.filter(isPlaced);
  for (const loose of LOOSE_M) {
    for (const [dx, dy] of spots) {
      const [x, y] = [toMillimetre(middle[0] + dx), toMillimetre(middle[1] + dy)];
      if (!reaches(x, y)) continue;
      const thing = { xyz: [x, y, z], size };
      const isFree = (other) => (clearance(thing, other)?.gap ?? Number.POSITIVE_INFINITY) >= loose;
      if (placed.every(isFree)) return [x, y];
    }
  }
  return middle;
}

/** Moves an object by metres. @param {any} object @param {number} dx @param {number} dy */
export function moveBy(object, dx, dy) {
  const [x, y, z] = object.xyz;
  object.xyz = [toMillimetre(x + dx), toMillimetre(y + dy), z];
}

/** Turns an object to an angle between -π and π. @param {any} object @param {number} radians */
export function turnTo(object, radians) {
  const turned = Math.atan2(Math.sin(radians), Math.cos(radians));
  const yaw = Math.round(turned * 1e4) / 1e4 + 0;
  object.yaw = yaw === 0 && object.yaw == null ? null : yaw;
}

/** Sets the extents; an object on another one stays there. @param {any} object @param {number[]} size */
export function resize(object, size) {
  if (object.xyz) object.xyz[2] = rounded(object.xyz[2] + (size[2] - (object.size?.[2] ?? 0)) / 2);
  object.size = size;
}

/** Takes the place away, or gives one: an object without one can be talked about only. */
export function setPlaced(object, xyz) {
  if (xyz) {
    object.size ??= [...PLAIN.size];
    object.grasp_width ??= PLAIN.grasp_width;
    object.xyz = xyz;
  } else {
    for (const key of ["xyz", "yaw", "size", "grasp_width", "mass_kg", "form", "wall_deg"]) {
      object[key] = null;
    }
  }
}

/** Sets the value of an attribute, "" for none. */
export function setValue(object, attribute, value) {
  if (value) object.attributes[attribute] = value;
  else delete object.attributes[attribute];
}

export function addAttribute(document) {
  const name = freeName(document.attributes, "attribute");
  document.attributes.push({ from: null, name, synonyms: [], values: [] });
}

export function removeAttribute(document, k) {
  const [{ name }] = document.attributes.splice(k, 1);
  for (const { attributes } of document.objects) delete attributes[name];
}

export function renameAttribute(document, k, name) {
  const before = document.attributes[k].name;
  document.attributes[k].name = name;
  for (const object of document.objects) {
    const pairs = Object.entries(object.attributes);
    object.attributes = Object.fromEntries(
      pairs.map(([key, value]) => [key === before ? name : key, value]),
    );
  }
}

export function addValue(document, k) {
  const { values } = document.attributes[k];
  values.push({ from: null, name: freeName(values, "value"), synonyms: [] });
}

export function removeValue(document, k, v) {
  const attribute = document.attributes[k];
  const [{ name }] = attribute.values.splice(v, 1);
  for (const { attributes } of document.objects) {
    if (attributes[attribute.name] === name) delete attributes[attribute.name];
  }
}

export function renameValue(document, k, v, name) {
  const attribute = document.attributes[k];
  const before = attribute.values[v].name;
  attribute.values[v].name = name;
  for (const { attributes } of document.objects) {
    if (attributes[attribute.name] === before) attributes[attribute.name] = name;
  }
}

/**
 * Subject of a problem.
 * @param {{key: string}} problem
 * @returns {{kind: "object"|"attribute"|"scene", n: number}}
 */
export function about({ key }) {
  const found = /^(object|attribute)s\[(\d+)\]/.exec(key);
  if (!found) return { kind: "scene", n: -1 };
  return { kind: /** @type {"object"|"attribute"} */ (found[1]), n: Number(found[2]) };
}

/**
 * The place that a problem's help proposes.
 * @param {{cure: string}} problem
 * @returns {number[]|null}
 */
export function proposedPlace({ cure }) {
  const numbers = /xyz = \[([^\]]+)\]$/.exec(cure)?.[1].split(",").map(Number);
  return numbers?.length === 3 && numbers.every(Number.isFinite) ? numbers : null;
}
