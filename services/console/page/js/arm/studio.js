// @ts-check
import {
  Color,
  CubeTexture,
  DataTexture,
  DataUtils,
  HalfFloatType,
} from "../../vendor/three/build/three.module.js";

/**
 * Pixels along a side of each picture of the studio, for increasingly rough surfaces. The last one
 * is for light from all around. `PMREMGenerator` of three makes the same at 256 pixels, which takes
 * seconds without a graphics card and looks no better on bowls. After an update of three, check
 * that it still stores them as mipmaps of a cube.
 */
const SIZES = [32, 16, 8];
/** Directions from which light is gathered for each pixel of a rough picture. */
const GATHERED = 128;
/** Along each axis of a pixel of the sharp one. */
const FINE = 2;

/**
 * The studio around the robot: boxes far away, seen from the middle, metres.
 * @typedef {{low: number[], high: number[], light: number[]}} Panel `light`: red, green, blue
 */

/**
 * A studio with a bright ceiling and two windows.
 * @param {boolean} dark
 * @returns {{walls: number[], panels: Panel[]}}
 */
function studioOf(dark) {
  const lit = (colour, strength) => new Color(colour).multiplyScalar(strength).toArray();
  const panel = ([x, y, z], [wide, deep, tall], light) => ({
    low: [x - wide / 2, y - deep / 2, z - tall / 2],
    high: [x + wide / 2, y + deep / 2, z + tall / 2],
    light,
  });
  return {
    walls: dark ? lit(0x394453, 0.55) : lit(0xaab0b8, 0.9),
    panels: [
      panel([1, 0, 7], [5, 5, 0.1], lit(0xffffff, dark ? 5 : 6)),
      panel([7, 4, 3], [0.1, 3, 4], lit(0xffffff, 4)),
      panel([0, -7, 2], [3, 0.1, 3], lit(0xdde8ff, dark ? 3 : 2.5)),
      panel([0, 0, -4], [20, 20, 0.1], lit(dark ? 0x14171c : 0x8f8a82, 0.8)),
    ],
  };
}

/**
 * The light that comes from a direction: of the nearest panel there, or of the walls.
 * @param {{walls: number[], panels: Panel[]}} studio
 * @param {number} x @param {number} y @param {number} z
 */
export function lightFrom({ walls, panels }, x, y, z) {
  let nearest = Number.POSITIVE_INFINITY;
  let light = walls;
  for (const panel of panels) {
    const at = Math.max(
      Math.min(panel.low[0] / x, panel.high[0] / x),
      Math.min(panel.low[1] / y, panel.high[1] / y),
      Math.min(panel.low[2] / z, panel.high[2] / z),
    );
    const end = Math.min(
      Math.max(panel.low[0] / x, panel.high[0] / x),
      Math.max(panel.low[1] / y, panel.high[1] / y),
      Math.max(panel.low[2] / z, panel.high[2] / z),
    );
    if (at <= 0 || at > end || at >= nearest) continue;
    nearest = at;
    light = panel.light;
  }
  return light;
}

/**
 * The reflected environment, in the form that the materials read.
 * @param {boolean} dark
 * @returns {any} a texture
 */
export function studio(dark) {
  const room = studioOf(dark);
  const levels = SIZES.map((size, n) => {
    const roughness = 1 - Math.sqrt(1 - n / (SIZES.length - 1));
    return cube(size, n === 0 ? sharp(room, size) : rough(room, roughness));
  });
  // Materials take the last level but one for the roughest.
  levels.push(cube(SIZES[SIZES.length - 1] / 2, () => room.walls));
  const texture = new CubeTexture(/** @type {any} */ (levels[0]));
  texture.mipmaps = levels.slice(1).map((image) => ({ image, width: SIZES[0] }));
  texture.type = HalfFloatType;
  texture.generateMipmaps = false;
  texture.needsUpdate = true;
  return Object.assign(texture, { isPMREMTexture: true });
}

/** Direction of a pixel on each side of a cube seen from within: x is mirrored. */
const SIDES = [
  (s, t) => [-1, -t, -s],
  (s, t) => [1, -t, s],
  (s, t) => [-s, 1, t],
  (s, t) => [-s, -1, -t],
  (s, t) => [-s, -t, 1],
  (s, t) => [s, -t, -1],
];

/** The six sides of a picture of all directions. */
function cube(size, lightOf) {
  const at = (n) => (2 * (n + 0.5)) / size - 1;
  return SIDES.map((side) => {
    const data = new Uint16Array(4 * size * size).fill(DataUtils.toHalfFloat(1));
    for (let n = 0; n < size * size; n++) {
      const light = lightOf(at(n % size), at(Math.floor(n / size)), side);
      for (let k = 0; k < 3; k++) data[4 * n + k] = DataUtils.toHalfFloat(light[k]);
    }
    return new DataTexture(data, size, size);
  });
}

/** Light on a mirror: the mean over a pixel, so that edges are soft. */
function sharp(room, size) {
  const steps = Array.from({ length: FINE }, (_, n) => ((2 * n + 1) / FINE - 1) / size);
  return (s, t, side) => {
    const mean = new Mean();
    for (const ds of steps) {
      for (const dt of steps) mean.add(lightFrom(room, ...side(s + ds, t + dt)), 1);
    }
    return mean.light;
  };
}

/** Light on a rough surface that is looked at from straight above. */
function rough(room, roughness) {
  const lobe = gathered(roughness);
  return (s, t, side) => {
    const [x, y, z] = unit(side(s, t));
    // Two directions across, as good as any others.
    const a = unit(Math.abs(z) < 0.9 ? [y, -x, 0] : [0, z, -y]);
    const b = [y * a[2] - z * a[1], z * a[0] - x * a[2], x * a[1] - y * a[0]];
    const mean = new Mean();
    for (const [u, v, w] of lobe) {
      const way = (k, up) => u * a[k] + v * b[k] + w * up;
      mean.add(lightFrom(room, way(0, x), way(1, y), way(2, z)), w);
    }
    return mean.light;
  };
}

/**
 * Directions, z along the surface's normal, from which a rough surface throws light to one who looks
 * straight at it; denser where it throws more (microfacets by Trowbridge and Reitz).
 */
function gathered(roughness) {
  const golden = Math.PI * (3 - Math.sqrt(5));
  const spread = roughness ** 4;
  const lobe = Array.from({ length: GATHERED }, (_, n) => {
    const share = (n + 0.5) / GATHERED;
    const tilt = 2 * Math.acos(Math.sqrt((1 - share) / (1 + (spread - 1) * share)));
    const across = Math.sin(tilt);
    return [across * Math.cos(n * golden), across * Math.sin(n * golden), Math.cos(tilt)];
  });
  return lobe.filter(([, , up]) => up > 0);
}

class Mean {
  #sum = [0, 0, 0];
  #weight = 0;

  add(light, weight) {
    for (let k = 0; k < 3; k++) this.#sum[k] += weight * light[k];
    this.#weight += weight;
  }

  get light() {
    return this.#sum.map((value) => value / this.#weight);
  }
}

function unit(way) {
  const long = Math.hypot(...way);
  return way.map((value) => value / long);
}
