// @ts-check
import {
  Color,
  DoubleSide,
  Group,
  Matrix4,
  Mesh,
  MeshLambertMaterial,
  MeshStandardMaterial,
  Quaternion,
  Vector3,
} from "../../vendor/three/build/three.module.js";
import { ball, box, lathe, merged, ring } from "./bodies.js";
import { halo } from "./glow.js";
import { lookOf, partsOf } from "./looks.js";

/** Duration of an object's move to its new place, milliseconds. */
const PUT_MS = 450;
/** Farther than this it does not creep there but was put. */
const PUT_M = 0.02;
const ACCENT = 0xffb020;
const BEST = 0x34d399;

const SIDES = {
  x: new Matrix4().makeRotationY(Math.PI / 2),
  y: new Matrix4().makeRotationX(-Math.PI / 2),
};

/** The objects of a scene, each at its place in the world, or in a gripper. */
export class Things {
  object = new Group();
  /** @type {Thing[]} */
  #things = [];

  /** Number of objects. */
  get count() {
    return this.#things.length;
  }

  /** Makes those of a scene. @param {any} scene section `scene` */
  setScene(scene) {
    for (const thing of this.#things) thing.dispose();
    this.object.clear();
    this.#things = scene.objects.map((object) => new Thing(object, scene.noun));
    for (const thing of this.#things) this.object.add(thing.object, thing.halo);
  }

  /**
   * Puts an object somewhere in the room.
   * @param {number} n its place in the scene
   * @param {Matrix4} pose
   * @param {number} now page time, milliseconds
   */
  put(n, pose, now) {
    this.#things[n]?.put(pose, now);
  }

  /**
   * Has an object move with a frame.
   * @param {number} n its place in the scene
   * @param {any} frame
   * @param {Matrix4} inFrame its pose there
   */
  hold(n, frame, inFrame) {
    this.#things[n]?.hold(frame, inFrame);
  }

  /** Marks the dialogue's belief about each. @param {{belief: number|null, best: boolean, asked: boolean}[]} thoughts */
  mark(thoughts) {
    for (const [n, thing] of this.#things.entries()) thing.mark(thoughts[n]);
  }

  /**
   * Moves the objects under way.
   * @param {number} now page time, milliseconds
   * @returns {boolean} whether anything still is
   */
  step(now) {
    let busy = false;
    for (const thing of this.#things) busy = thing.step(now) || busy;
    return busy;
  }

  /** Sets the texture that the shiny ones mirror. @param {any} texture */
  setMirrored(texture) {
    for (const thing of this.#things) thing.setMirrored(texture);
  }

  /** Computes an object's position, metres. @param {number} n @param {Vector3} into */
  placeOf(n, into) {
    return into.setFromMatrixPosition(this.#things[n].object.matrixWorld);
  }

  /** Corners of the box around an object, metres. @param {number} n @returns {Vector3[]} */
  cornersOf(n) {
    const { object, size } = this.#things[n];
    const sign = (corner, axis) => ((corner >> axis) & 1 ? 0.5 : -0.5);
    return Array.from({ length: 8 }, (_, corner) => {
      const [x, y, z] = size.map((side, axis) => side * sign(corner, axis));
      return new Vector3(x, y, z).applyMatrix4(object.matrixWorld);
    });
  }

  /** Which object moves with a gripper, -1 for none. */
  get held() {
    return this.#things.findIndex((thing) => thing.isHeld);
  }
}

class Thing {
  object = new Group();
  #frame = null;
  #inFrame = new Matrix4();
  #from = { place: new Vector3(), turn: new Quaternion(), at: Number.NEGATIVE_INFINITY };
  #to = { place: new Vector3(), turn: new Quaternion() };
  #isPut = false;
  #isMarked = false;

  constructor({ name, attributes, size }, noun) {
    const look = lookOf({ name, attributes, size }, noun);
    this.size = size;
    this.object.name = name;
    this.material = materialOf(look);
    this.mesh = new Mesh(geometryOf(partsOf(look.form, size), look), this.material);
    this.mesh.castShadow = look.finish !== "clear";
    this.mesh.receiveShadow = true;
    this.object.add(this.mesh);
    this.halo = halo();
  }

  get isHeld() {
    return this.#frame !== null;
  }

  put(pose, now) {
    const { place, turn } = this.#to;
    pose.decompose(place, turn, new Vector3());
    if (!this.#isPut) this.object.position.copy(place);
    const far = place.distanceTo(this.object.position) > PUT_M;
    const creeps = this.#isPut && far && (this.#frame || now >= this.#from.at + PUT_MS);
    if (creeps) {
      this.#from = {
        place: this.object.position.clone(),
        turn: this.object.quaternion.clone(),
        at: now,
      };
    }
    this.#frame = null;
    this.#isPut = true;
  }

  hold(frame, inFrame) {
    this.#frame = frame;
    this.#inFrame.copy(inFrame);
    this.#isPut = true;
  }

  step(now) {
    const share = Math.min(Math.max((now - this.#from.at) / PUT_MS, 0), 1);
    if (this.#frame) {
      const pose = this.#frame.matrixWorld.clone().multiply(this.#inFrame);
      pose.decompose(this.object.position, this.object.quaternion, new Vector3());
    } else {
      const eased = share * share * (3 - 2 * share);
      this.object.position.lerpVectors(this.#from.place, this.#to.place, eased);
      this.object.quaternion.slerpQuaternions(this.#from.turn, this.#to.turn, eased);
    }
    this.halo.position.copy(this.object.position);
    this.halo.position.z -= this.size[2] / 2 - 0.004;
    this.halo.visible = this.#isMarked && !this.#frame;
    return !this.#frame && share < 1;
  }

  mark(thought) {
    const asked = thought?.asked ?? false;
    const best = thought?.best ?? false;
    const across = Math.hypot(this.size[0], this.size[1]) / 2 + 0.035;
    this.#isMarked = asked || best;
    this.halo.scale.setScalar(across);
    this.halo.show(asked ? ACCENT : BEST, asked ? 1 : 0.25 + 0.75 * (thought?.belief ?? 0), asked);
    this.material.emissive.set(asked ? ACCENT : BEST);
    this.material.emissiveIntensity = asked ? 0.1 : best ? 0.08 * (thought?.belief ?? 0) : 0;
  }

  setMirrored(texture) {
    if (!("envMap" in this.material) || this.material.isMeshLambertMaterial) return;
    this.material.envMap = texture;
  }

  dispose() {
    this.mesh.geometry.dispose();
    this.material.dispose();
    this.halo.dispose();
  }
}

function materialOf({ finish }) {
  const common = { vertexColors: true, side: DoubleSide };
  switch (finish) {
    case "clear":
      return new MeshStandardMaterial({
        ...common,
        transparent: true,
        opacity: 0.42,
        roughness: 0.06,
        metalness: 0,
        envMapIntensity: 1.8,
        depthWrite: false,
      });
    case "metal":
      return new MeshStandardMaterial({
        ...common,
        roughness: 0.22,
        metalness: 0.95,
        envMapIntensity: 1.3,
      });
    default:
      return new MeshLambertMaterial(common);
  }
}

function geometryOf(parts, look) {
  return merged(
    parts.map((part) => {
      const matrix = new Matrix4().setPosition(...part.at);
      if (SIDES[part.along]) matrix.multiply(SIDES[part.along]);
      return { geometry: bodyOf(part), matrix, colour: new Color(part.colour ?? look.colour) };
    }),
  );
}

function bodyOf({ body, profile, size }) {
  switch (body) {
    case "lathe":
      return lathe(profile, 32);
    case "box":
      return box(size);
    case "ring":
      return ring(size[0], size[1]);
    default:
      return ball(size[0]);
  }
}
