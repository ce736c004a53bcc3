// @ts-check
import { Vector3 } from "../../vendor/three/build/three.module.js";

/** Nominal place of an object behind the camera: outside the picture, in halves of it. */
const OUTSIDE = 1.2;

/**
 * Places of the objects in the picture: the box around each, pixels of the page. That of an object behind
 * the camera is a point outside, on the side to which one would turn.
 * @param {import("./things.js").Things} things
 * @param {any} camera
 * @param {{width: number, height: number}} size of the picture
 * @returns {import("./placement.js").Rect[]}
 */
export function objectBoxes(things, camera, size) {
  return Array.from({ length: things.count }, (_, n) => {
    const corners = things.cornersOf(n).map((corner) => corner.project(camera));
    if (corners.some(({ z }) => z > 1))
      return behind(things.placeOf(n, new Vector3()), camera, size);
    return around(corners, size);
  });
}

function around(points, { width, height }) {
  const xs = points.map(({ x }) => ((x + 1) / 2) * width);
  const ys = points.map(({ y }) => ((1 - y) / 2) * height);
  const [x, y] = [Math.min(...xs), Math.min(...ys)];
  return {
    x: tenths(x),
    y: tenths(y),
    width: tenths(Math.max(...xs) - x),
    height: tenths(Math.max(...ys) - y),
  };
}

function behind(place, camera, size) {
  const { x, y, z } = place.project(camera);
  const sign = z > 1 ? -1 : 1;
  const scale = (sign * OUTSIDE) / Math.max(Math.abs(x), Math.abs(y), 1e-6);
  return around([{ x: x * scale, y: y * scale }], size);
}

/** Smaller changes are invisible and are not sent. */
const tenths = (pixels) => Math.round(10 * pixels) / 10;
