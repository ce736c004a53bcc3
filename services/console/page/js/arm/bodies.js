// @ts-check
import {
  BufferAttribute,
  BufferGeometry,
  CapsuleGeometry,
  Color,
  Euler,
  Matrix4,
  Quaternion,
  SphereGeometry,
  TorusGeometry,
  Vector3,
} from "../../vendor/three/build/three.module.js";
import { RoundedBoxGeometry } from "../../vendor/three/examples/jsm/geometries/RoundedBoxGeometry.js";

/** Corners of a profile that are sharper than this stay sharp, cosine. */
const SHARP = Math.cos(0.9);
const AROUND = 20;

/**
 * A body of revolution about z.
 * @param {[number, number][]} profile distance from the axis and height, from below the outside up
 * @param {number} [around] sides
 */
export function lathe(profile, around = AROUND) {
  const [positions, normals, indices] = [[], [], []];
  const sides = profile.slice(1).map(([r, z], n) => sideOf(profile[n], [r, z]));
  for (const [n, own] of sides.entries()) {
    const first = positions.length / 3;
    ring(profile[n], blend(sides[n - 1], own));
    ring(profile[n + 1], blend(sides[n + 1], own));
    for (let k = 0; k < around; k++) {
      const [a, b] = [first + k, first + k + around + 1];
      // On the axis a side is a triangle.
      if (profile[n][0] > 0) indices.push(a, a + 1, b + 1);
      if (profile[n + 1][0] > 0) indices.push(a, b + 1, b);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(positions), 3));
  geometry.setAttribute("normal", new BufferAttribute(new Float32Array(normals), 3));
  geometry.setIndex(indices);
  return geometry;

  function ring([r, z], [outwards, upwards]) {
    for (let k = 0; k <= around; k++) {
      const [cos, sin] = [
        Math.cos((2 * Math.PI * k) / around),
        Math.sin((2 * Math.PI * k) / around),
      ];
      positions.push(r * cos, r * sin, z);
      normals.push(outwards * cos, outwards * sin, upwards);
    }
  }
}

/** The normal of a profile's side, outwards and upwards. */
function sideOf([r, z], [r2, z2]) {
  const long = Math.hypot(r2 - r, z2 - z) || 1;
  return [(z2 - z) / long, (r - r2) / long];
}

function blend(other, own) {
  if (!other || other[0] * own[0] + other[1] * own[1] < SHARP) return own;
  const sum = [other[0] + own[0], other[1] + own[1]];
  const long = Math.hypot(sum[0], sum[1]) || 1;
  return sum.map((value) => value / long);
}

/**
 * A cylinder about z with a small bevel, as things have that were made.
 * @param {number} radius metres
 * @param {number} length metres
 */
export function cylinder(radius, length) {
  const bevel = Math.min(0.12 * radius, 0.2 * length, 0.008);
  const [inner, half] = [radius - bevel, length / 2];
  return lathe([
    [0, -half],
    [inner, -half],
    [radius, bevel - half],
    [radius, half - bevel],
    [inner, half],
    [0, half],
  ]);
}

/** @param {number[]} size metres */
export function box([x, y, z]) {
  const least = Math.min(x, y, z);
  return new RoundedBoxGeometry(x, y, z, 1, Math.min(0.25 * least, 0.012));
}

/** @param {number} radius metres */
export function ball(radius) {
  return new SphereGeometry(radius, 20, 12);
}

/** Along z. @param {number} radius metres @param {number} length between the centres of its ends */
export function capsule(radius, length) {
  return new CapsuleGeometry(radius, length, 5, AROUND).rotateX(Math.PI / 2);
}

/** About z. @param {number} radius to the middle of its band @param {number} thick half of it */
export function ring(radius, thick) {
  return new TorusGeometry(radius, thick, 6, 20);
}

/**
 * A pose of the robot's description.
 * @param {number[]} xyz metres
 * @param {number[]} rpy radians, about the fixed axes x, y, z in this order
 */
export function poseMatrix(xyz, rpy) {
  const turn = new Quaternion().setFromEuler(new Euler(rpy[0], rpy[1], rpy[2], "ZYX"));
  return new Matrix4().compose(new Vector3(...xyz), turn, new Vector3(1, 1, 1));
}

/**
 * One geometry of several, each with a place and a colour of its own: one call to draw them all.
 * @param {{geometry: BufferGeometry, matrix: Matrix4, colour: Color}[]} parts
 */
export function merged(parts) {
  const [positions, normals, colours, indices] = [[], [], [], []];
  for (const { geometry, matrix, colour } of parts) {
    geometry.applyMatrix4(matrix);
    const { position, normal } = geometry.attributes;
    const first = positions.length / 3;
    for (const value of position.array) positions.push(value);
    for (const value of normal.array) normals.push(value);
    for (let n = 0; n < position.count; n++) colours.push(colour.r, colour.g, colour.b);
    const own = geometry.index?.array ?? position.array.slice(0, position.count).map((_, n) => n);
    for (const index of own) indices.push(first + index);
    geometry.dispose();
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(positions), 3));
  geometry.setAttribute("normal", new BufferAttribute(new Float32Array(normals), 3));
  geometry.setAttribute("color", new BufferAttribute(new Float32Array(colours), 3));
  geometry.setIndex(indices);
  geometry.computeBoundingSphere();
  return geometry;
}
