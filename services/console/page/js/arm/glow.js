// @ts-check
import {
  BufferAttribute,
  BufferGeometry,
  Mesh,
  MeshBasicMaterial,
} from "../../vendor/three/build/three.module.js";

const AROUND = 56;

/**
 * A flat disc about z whose density depends on the distance from its middle.
 * @param {[number, number][]} rings distance and density, from the middle outwards
 */
export function disc(rings) {
  const [positions, colours, indices] = [[], [], []];
  for (const [n, [radius, density]] of rings.entries()) {
    for (let k = 0; k < AROUND; k++) {
      const angle = (2 * Math.PI * k) / AROUND;
      positions.push(radius * Math.cos(angle), radius * Math.sin(angle), 0);
      colours.push(1, 1, 1, density);
      if (n === 0) continue;
      const [a, b] = [(n - 1) * AROUND + k, (n - 1) * AROUND + ((k + 1) % AROUND)];
      indices.push(a, a + AROUND, b + AROUND, a, b + AROUND, b);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(positions), 3));
  geometry.setAttribute("color", new BufferAttribute(new Float32Array(colours), 4));
  geometry.setAttribute(
    "normal",
    new BufferAttribute(new Float32Array(positions.map((_, n) => (n % 3 === 2 ? 1 : 0))), 3),
  );
  geometry.setIndex(indices);
  return geometry;
}

/** The light of likely objects, and the ring of the object in question. */
const LIT = [
  [0.55, 0],
  [0.72, 0.85],
  [0.82, 0.55],
  [1.25, 0.12],
  [1.7, 0],
];
const ASKED = [
  [0.7, 0],
  [0.74, 1],
  [0.86, 1],
  [0.9, 0.35],
  [1.35, 0],
];

class Halo extends Mesh {
  #shapes = [disc(/** @type {any} */ (LIT)), disc(/** @type {any} */ (ASKED))];

  constructor() {
    super(
      undefined,
      new MeshBasicMaterial({ vertexColors: true, transparent: true, depthWrite: false }),
    );
    this.geometry = this.#shapes[0];
    this.visible = false;
    this.renderOrder = 1;
  }

  /**
   * @param {number} colour
   * @param {number} strength of one
   * @param {boolean} asked whether it is the sharp ring of the object in question
   */
  show(colour, strength, asked) {
    this.geometry = this.#shapes[asked ? 1 : 0];
    this.material.color.set(colour);
    this.material.opacity = strength;
  }

  dispose() {
    for (const shape of this.#shapes) shape.dispose();
    this.material.dispose();
  }
}

/** A ring of light under an object, of radius 1. */
export function halo() {
  return new Halo();
}
