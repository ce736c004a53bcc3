// @ts-check
import { Matrix4, Quaternion, Scene, Vector3 } from "../../vendor/three/build/three.module.js";
import { boardsUnder, personsPlaces, tableTop } from "./boards.js";
import { CourseLine } from "./course.js";
import { RobotModel } from "./robot.js";
import { Room } from "./room.js";
import { Things } from "./things.js";

/** The robot's own light while motion is stopped. */
const ALARM = { colour: 0x7f1d1d, strength: 0.55 };
/** A way too small to be seen. */
const SPECK = {
  phases: [
    {
      name: "clear",
      points: [
        [0, 0, 0],
        [0.003, 0, 0],
      ],
      t_s: [0, 1],
    },
  ],
};

/** Contents of the picture: a robot, its room, the objects, and knowledge about them. */
export class Tableau {
  scene = new Scene();
  things = new Things();
  course = new CourseLine();
  /** @type {RobotModel|null} */
  robot = null;
  #room = new Room();
  #spec = null;
  #world = null;
  #trajectory = null;
  #arm = null;
  #thoughts = [];

  constructor() {
    this.scene.add(this.#room.object, this.things.object, this.course.object);
  }

  /** The objects as the scene has them. */
  get objects() {
    return this.#spec?.objects ?? [];
  }

  /** Returns whether the arm reports that it moves. */
  get isMoving() {
    return Boolean(this.#arm?.moving);
  }

  /**
   * @param {import("./elements.js").Tree} description the robot's URDF
   * @param {{q: number[], grip: number[]}|undefined} joints their positions, if known
   */
  setRobot(description, joints) {
    const robot = new RobotModel(description);
    if (this.robot) {
      this.scene.remove(this.robot.object);
      this.robot.dispose();
    }
    this.robot = robot;
    this.scene.add(robot.object);
    if (joints) robot.pose(joints.q, joints.grip);
    this.#room.setGround(robot.bounds().low[2]);
    this.#furnish();
    this.setWorld(this.#world);
    this.setArm(this.#arm);
  }

  /** @param {any} spec section `scene` */
  setScene(spec) {
    this.#spec = spec;
    this.things.setScene(spec);
    this.#furnish();
    this.setWorld(this.#world);
    this.setThoughts(this.#thoughts);
  }

  /** @param {any} world section `world` */
  setWorld(world) {
    this.#world = world;
    const now = performance.now();
    const poses = world?.objects?.length === this.objects.length ? world.objects : null;
    const gone = poses ? poses.flatMap((pose, n) => (pose ? [] : [n])) : [];
    const places = personsPlaces(this.objects, gone);
    for (const [n, object] of this.objects.entries()) {
      const held = poses && this.#heldBy(n, world);
      if (held) this.things.hold(n, held.frame, held.inFrame);
      else if (poses?.[n]) this.things.put(n, poseOf(poses[n]), now);
      else this.things.put(n, placed(places.get(n) ?? object.xyz, object.yaw), now);
    }
  }

  /** @param {any} trajectory section `trajectory` */
  setTrajectory(trajectory) {
    this.#trajectory = trajectory;
    this.course.show(trajectory);
  }

  /** @param {{belief: number|null, best: boolean, asked: boolean}[]} thoughts in the scene's order */
  setThoughts(thoughts) {
    this.#thoughts = thoughts;
    this.things.mark(thoughts);
  }

  /** @param {any} arm section `arm` */
  setArm(arm) {
    this.#arm = arm;
    const stopped = Boolean(arm?.stopped);
    this.#room.setStopped(stopped);
    this.robot?.setGlow(stopped ? ALARM.colour : 0, stopped ? ALARM.strength : 0);
  }

  /** @param {boolean} dark */
  setTheme(dark) {
    this.#room.setTheme(dark);
    this.course.setTheme(dark);
  }

  /**
   * @param {object} fineness
   * @param {number} fineness.shadow pixels of the shadows' picture along a side
   * @param {boolean} fineness.rich whether the robot mirrors the room
   * @param {any} fineness.mirrored reflections in shiny things, a texture
   */
  setFineness({ shadow, rich, mirrored }) {
    this.#room.setShadow(shadow);
    this.robot?.setRich(rich);
    this.things.setMirrored(mirrored);
  }

  /**
   * Moves everything to its place at an instant.
   * @param {number} now milliseconds
   * @param {import("./joints.js").Sample|null} sample the joints then
   * @returns {boolean} whether any object is still on its way
   */
  step(now, sample) {
    if (sample) this.robot?.pose(sample.q, sample.grip);
    this.scene.updateMatrixWorld();
    const began = this.#trajectory?.began_ms;
    if (sample && began != null) this.course.passed((sample.atMs - began) / 1000);
    return this.things.step(now);
  }

  /**
   * Draws with an invisible trajectory in the picture.
   * @param {() => void} draw
   */
  withSpeck(draw) {
    this.course.show(SPECK);
    draw();
    this.course.show(this.#trajectory);
  }

  /** The gripper that holds an object, and the object's pose in it. */
  #heldBy(n, world) {
    if (world.held !== n && world.held !== this.objects[n].name) return null;
    const object = poseOf(world.objects[n]);
    const limbs = this.robot?.grippers.length ?? world.grippers.length;
    const far = world.grippers
      .slice(0, limbs)
      .map(([x, y, z]) => Math.hypot(...[x, y, z].map((v, k) => v - world.objects[n][k])));
    const side = far[1] < far[0] ? 1 : 0;
    const frame = this.robot?.grippers[side];
    return frame
      ? { frame, inFrame: poseOf(world.grippers[side]).invert().multiply(object) }
      : null;
  }

  #furnish() {
    if (!this.#spec || !this.robot) return;
    this.#room.setBoards(boardsUnder(this.objects), tableTop(this.objects));
  }
}

/** @param {number[]} pose x, y, z, and quaternion x, y, z, w */
function poseOf([x, y, z, i, j, k, w]) {
  return new Matrix4().compose(
    new Vector3(x, y, z),
    new Quaternion(i, j, k, w),
    new Vector3(1, 1, 1),
  );
}

function placed([x, y, z], yaw) {
  return new Matrix4().makeRotationZ(yaw).setPosition(x, y, z);
}
