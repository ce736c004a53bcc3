// @ts-check
import { Vector3 } from "../../vendor/three/build/three.module.js";

/** Height of a label's foot above its object, metres. */
const ABOVE_M = 0.02;

/**
 * Places of the objects' labels in the picture.
 * @param {import("./things.js").Things} things
 * @param {any} camera
 * @param {{width: number, height: number}} size of the picture, pixels of the page
 * @returns {({x: number, y: number}|null)[]} pixels of the page; null: not seen
 */
export function labelPlaces(things, camera, { width, height }) {
  const point = new Vector3();
  return Array.from({ length: things.count }, (_, n) => {
    things.placeOf(n, point);
    point.z += things.heightOf(n) / 2 + ABOVE_M;
    point.project(camera);
    if (point.z > 1) return null;
    return { x: tenths(((point.x + 1) / 2) * width), y: tenths(((1 - point.y) / 2) * height) };
  });
}

/** Smaller changes are invisible and are not sent. */
const tenths = (pixels) => Math.round(10 * pixels) / 10;
