// @ts-check
import {
  Box3,
  Color,
  Mesh,
  MeshLambertMaterial,
  MeshStandardMaterial,
  SRGBColorSpace,
  Vector3,
} from "../../vendor/three/build/three.module.js";
import URDFLoader from "../../vendor/urdf-loader/src/URDFLoader.js";
import { ball, box, capsule, cylinder, merged, poseMatrix } from "./bodies.js";
import { TreeElement } from "./elements.js";
import { fingerPosition, JOINT_NAMES, LIMB_JOINTS, LIMBS, limbNames } from "./joints.js";

/** Paint of a robot whose description gives no colours. */
const BARE = [0.55, 0.57, 0.6];

/** The robot of a description, at any joint positions. */
export class RobotModel {
  /** Joints of the server's messages: the setter of each. @type {(((q: number) => void)|null)[]} */
  #setters;
  #rich;
  #plain;
  #meshes = [];
  /** Joints of the fingers of both grippers. @type {any[][]} */
  #fingers;

  /** @param {import("./elements.js").Tree} description the robot's URDF */
  constructor(description) {
    const loader = new URDFLoader();
    // The visible shapes are made here, so that each link is drawn in one call, and capsules too.
    loader.parseVisual = false;
    this.object = loader.parse(/** @type {any} */ (new TreeElement(description)));
    this.#rich = new MeshStandardMaterial({ vertexColors: true, roughness: 0.42, metalness: 0.12 });
    this.#plain = new MeshLambertMaterial({ vertexColors: true });
    this.object.updateMatrixWorld(true);
    for (const [carrier, bodies] of bodiesOf(this.object)) {
      this.#meshes.push(dress(carrier, bodies, this.#rich));
    }
    const names = limbNames(this.object);
    const limbs = names.map((limb) => limbJoints(this.object, limb));
    this.#setters = JOINT_NAMES.map((name) => setter(this.object, limbs, name));
    this.#fingers = names.map((limb, n) => fingersOf(this.object, limbs[n], limb));
    /** The frames that hold things, left and right, or the only one. */
    this.grippers = names.map((limb) => this.object.links[`${limb}_gripper`] ?? null);
  }

  /** Number of bodies drawn. */
  get bodies() {
    return this.#meshes.reduce((sum, mesh) => sum + mesh.userData.bodies, 0);
  }

  /**
   * @param {number[]} q radians, in the order of `JOINT_NAMES`
   * @param {number[]} grip opening of both grippers, percent
   */
  pose(q, grip) {
    for (const [n, set] of this.#setters.entries()) set?.(q[n]);
    for (const [n, fingers] of this.#fingers.entries()) {
      for (const joint of fingers) joint.setJointValue(fingerPosition(joint.limit, grip[n]));
    }
  }

  /**
   * Switches reflections of the room on the robot's surfaces on or off; on is slower to draw.
   * @param {boolean} rich
   */
  setRich(rich) {
    for (const mesh of this.#meshes) mesh.material = rich ? this.#rich : this.#plain;
  }

  /** Gives it a glow of its own. @param {number} colour @param {number} strength */
  setGlow(colour, strength) {
    for (const material of [this.#rich, this.#plain]) {
      material.emissive.set(colour);
      material.emissiveIntensity = strength;
    }
  }

  /** Present extent of the robot, metres. */
  bounds() {
    this.object.updateMatrixWorld(true);
    const { min, max } = new Box3().setFromObject(this.object);
    return { low: min.toArray(), high: max.toArray() };
  }

  /** Computes a link's position, metres in the root's frame. @param {string} link */
  placeOf(link) {
    this.object.updateMatrixWorld(true);
    const frame = this.object.links[link];
    return frame ? new Vector3().setFromMatrixPosition(frame.matrixWorld).toArray() : null;
  }

  /** Frees its memory on the graphics card. */
  dispose() {
    for (const mesh of this.#meshes) mesh.geometry.dispose();
    this.#rich.dispose();
    this.#plain.dispose();
  }
}

/** A limb's joints from the trunk to the gripper: by name, or else in their order. */
function limbJoints(robot, limb) {
  const named = LIMB_JOINTS.map((joint) => robot.joints[`${limb}_${joint}`]);
  if (named.every((joint) => joint?.isURDFJoint)) return named;
  const chain = [];
  for (let node = robot.links[`${limb}_gripper`]; node; node = node.parent) {
    if (node.isURDFJoint && ["revolute", "continuous"].includes(node.jointType))
      chain.unshift(node);
  }
  return chain;
}

function setter(robot, limbs, name) {
  const [limb, joint] = name.split("_");
  const side = LIMBS.indexOf(limb);
  // The only limb has the place of the left one.
  const own = side < 0 ? robot.joints[name] : limbs[side]?.[LIMB_JOINTS.indexOf(joint)];
  if (!own || own.jointType === "fixed") return null;
  own.ignoreLimits = true;
  return (value) => own.setJointValue(value);
}

/** Sliding joints beyond the limb's own; those that mimic another move with it. */
function fingersOf(robot, limb, side) {
  const last = limb.at(-1) ?? robot.links[`${side}_gripper`]?.parent;
  const fingers = [];
  last?.traverse((node) => {
    const moves = node.isURDFJoint && !limb.includes(node) && node.jointType !== "fixed";
    if (moves && !node.isURDFMimicJoint && node.limit.upper !== node.limit.lower)
      fingers.push(node);
  });
  return fingers;
}

/** All bodies by the link that carries them: parts that move together are drawn in one call. */
function bodiesOf(robot) {
  const found = new Map();
  for (const link of Object.values(robot.links)) {
    let carrier = link;
    while (carrier.parent?.jointType === "fixed") carrier = carrier.parent.parent;
    const onto = carrier.matrixWorld.clone().invert().multiply(link.matrixWorld);
    const bodies = seenOf(link, robot);
    for (const { matrix } of bodies) matrix.premultiply(onto);
    if (bodies.length > 0) found.set(carrier, [...(found.get(carrier) ?? []), ...bodies]);
  }
  return found;
}

/** Meshes of a link, or its bounding box if all of them are in files. */
function seenOf(link, robot) {
  const bodies = (kind) =>
    children(link.urdfNode, kind).flatMap((node) => bodyOf(node, robot) ?? []);
  const seen = bodies("visual");
  const isDrawn = children(link.urdfNode, "visual").length > 0;
  return seen.length === 0 && isDrawn ? bodies("collision") : seen;
}

function dress(link, bodies, material) {
  const mesh = new Mesh(merged(bodies), material);
  mesh.castShadow = true;
  mesh.receiveShadow = true;
  mesh.userData.bodies = bodies.length;
  link.add(mesh);
  return mesh;
}

function bodyOf(node, robot) {
  const shape = children(node, "geometry")[0]?.children[0];
  const geometry = shape && geometryOf(shape);
  if (!geometry) return null;
  const origin = children(node, "origin")[0];
  const matrix = poseMatrix(numbers(origin, "xyz", [0, 0, 0]), numbers(origin, "rpy", [0, 0, 0]));
  return { geometry, matrix, colour: colourOf(node, robot) };
}

function geometryOf(shape) {
  const number = (name) => Number.parseFloat(shape.getAttribute(name) ?? "0");
  switch (shape.nodeName) {
    case "box":
      return box(numbers(shape, "size", [0, 0, 0]));
    case "cylinder":
      return cylinder(number("radius"), number("length"));
    case "capsule":
      return capsule(number("radius"), number("length"));
    case "sphere":
      return ball(number("radius"));
    default:
      return null;
  }
}

function colourOf(node, robot) {
  const material = children(node, "material")[0];
  const name = material?.getAttribute("name");
  const known = children(robot.urdfRobotNode, "material").find(
    (m) => m.getAttribute("name") === name,
  );
  const colour = [material, known].map((m) => m && children(m, "color")[0]).find(Boolean);
  const [r, g, b] = numbers(colour, "rgba", BARE);
  return new Color().setRGB(r, g, b, SRGBColorSpace);
}

function children(node, name) {
  return (node?.children ?? []).filter((child) => child.nodeName === name);
}

function numbers(node, name, otherwise) {
  const text = node?.getAttribute(name);
  return text ? text.trim().split(/\s+/).map(Number) : otherwise;
}
