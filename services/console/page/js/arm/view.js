// @ts-check
import {
  Matrix4,
  PerspectiveCamera,
  Quaternion,
  Scene,
  Vector3,
} from "../../vendor/three/build/three.module.js";
import { boardsUnder, personsPlaces, tableTop } from "./boards.js";
import { boundsOf, FIELD_DEG, viewOf } from "./cameras.js";
import { CameraControls } from "./controls.js";
import { CourseLine } from "./course.js";
import { Rolling } from "./figures.js";
import { JointBuffer } from "./joints.js";
import { Painter } from "./painter.js";
import { RobotModel } from "./robot.js";
import { Room } from "./room.js";
import { Things } from "./things.js";

/** A picture that stands is drawn once more, finely, after this long, milliseconds. */
const STILL_MS = 140;
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
/** The picture goes on for so long after the last new joints: the next ones may be late. */
const LINGER_MS = 250;
/** The same while the arm says that it moves. */
const MOVING_MS = 2_000;

/** The picture: a robot, its room, and what is known of both. Draws only when something changes. */
export class ArmView {
  #scene = new Scene();
  #camera = new PerspectiveCamera(FIELD_DEG, 1, 0.05, 30);
  #room = new Room();
  #things = new Things();
  #course = new CourseLine();
  #joints = new JointBuffer();
  /** @type {RobotModel|null} */
  #robot = null;
  #world = null;
  #spec = null;
  #trajectory = null;
  #thoughts = [];
  #isDark = false;
  #isSeen = true;
  #frame = 0;
  #still = 0;
  #painter;
  #isWarm = false;
  #arm = null;
  #last = { at: 0, changed: true, fresh: Number.NEGATIVE_INFINITY };
  #figures = { frames: new Rolling(), work: new Rolling(), late: new Rolling() };
  #size = { width: 0, height: 0 };
  #view = "start";

  /**
   * @param {HTMLCanvasElement} canvas
   * @param {HTMLElement} stage takes the keys
   * @param {any} link the server's clock
   * @param {import("./overlay.js").Overlay} overlay
   */
  constructor(canvas, stage, link, overlay) {
    this.link = link;
    this.overlay = overlay;
    this.#painter = new Painter(canvas);
    this.#camera.up.set(0, 0, 1);
    this.#scene.add(this.#room.object, this.#things.object, this.#course.object);
    this.controls = new CameraControls(this.#camera, stage, canvas, () => this.request());
    canvas.addEventListener("webglcontextrestored", () => {
      this.#isWarm = false;
      this.#mirror();
    });
    document.addEventListener("visibilitychange", () => this.request());
    this.#mirror();
  }

  /** @param {string} description the robot's URDF */
  setRobot(description) {
    const robot = new RobotModel(description);
    if (this.#robot) {
      this.#scene.remove(this.#robot.object);
      this.#robot.dispose();
    }
    this.#robot = robot;
    this.#scene.add(robot.object);
    const latest = this.#joints.latest;
    if (latest) robot.pose(latest.q, latest.grip);
    this.#room.setGround(robot.bounds().low[2]);
    this.#furnish();
    this.setWorld(this.#world);
    this.setArm(this.#arm);
    this.look("start", true);
  }

  /** @param {any} spec section `scene` */
  setScene(spec) {
    if (!spec || spec.key === this.#spec?.key) return;
    this.#spec = spec;
    this.#things.setScene(spec);
    this.#things.setMirrored(this.#painter.mirrored);
    this.overlay.setScene(spec);
    this.#furnish();
    this.setWorld(this.#world);
    this.setThoughts(this.#thoughts);
    if (!this.controls.isMoved) this.look(this.#view, true);
  }

  /** @param {any} world section `world` */
  setWorld(world) {
    this.#world = world;
    if (!this.#spec) return;
    const now = performance.now();
    const poses = world?.objects?.length === this.#spec.objects.length ? world.objects : null;
    const gone = poses ? poses.flatMap((pose, n) => (pose ? [] : [n])) : [];
    const places = personsPlaces(this.#spec.objects, gone);
    for (const [n, object] of this.#spec.objects.entries()) {
      const held = poses && this.#heldBy(n, world);
      if (held) this.#things.hold(n, held.frame, held.inFrame);
      else if (poses?.[n]) this.#things.put(n, poseOf(poses[n]), now);
      else this.#things.put(n, placed(places.get(n) ?? object.xyz, object.yaw), now);
    }
    this.overlay.mark(this.#thoughts, this.#things.held);
    this.request();
  }

  /** The gripper that holds an object, and the object's pose in it. */
  #heldBy(n, world) {
    if (world.held !== n && world.held !== this.#spec.objects[n].name) return null;
    const object = poseOf(world.objects[n]);
    const far = world.grippers.map(([x, y, z]) =>
      Math.hypot(...[x, y, z].map((v, k) => v - world.objects[n][k])),
    );
    const side = far[0] <= far[1] ? 0 : 1;
    const frame = this.#robot?.grippers[side];
    return frame
      ? { frame, inFrame: poseOf(world.grippers[side]).invert().multiply(object) }
      : null;
  }

  /** @param {any} trajectory section `trajectory` */
  setTrajectory(trajectory) {
    this.#trajectory = trajectory;
    this.#course.show(trajectory);
    this.request();
  }

  /** @param {{belief: number|null, best: boolean, asked: boolean}[]} thoughts in the scene's order */
  setThoughts(thoughts) {
    this.#thoughts = thoughts;
    this.#things.mark(thoughts);
    this.overlay.mark(thoughts, this.#things.held);
    this.request();
  }

  /** @param {any} arm section `arm` */
  setArm(arm) {
    this.#arm = arm;
    const stopped = Boolean(arm?.stopped);
    this.#room.setStopped(stopped);
    this.#robot?.setGlow(stopped ? 0x7f1d1d : 0, stopped ? 0.55 : 0);
    this.request();
  }

  /** @param {{at_ms: number, q: number[], grip: number[]}} message */
  setJoints(message) {
    if (this.#joints.add(message, this.link.serverNow())) this.#last.fresh = performance.now();
    if (this.#isFresh(performance.now())) this.request();
  }

  /** @param {boolean} dark */
  setTheme(dark) {
    if (dark === this.#isDark) return;
    this.#isDark = dark;
    this.#mirror();
  }

  /** @param {number} width pixels of the page @param {number} height */
  setSize(width, height) {
    if (width < 1 || height < 1) return;
    this.#size = { width, height };
    this.#camera.aspect = width / height;
    this.#camera.updateProjectionMatrix();
    this.#painter.setSize(this.#size);
    this.overlay.measure();
    if (!this.controls.isMoved) this.look(this.#view, true);
    this.request();
  }

  /** Whether anybody can see it. @param {boolean} seen */
  setSeen(seen) {
    this.#isSeen = seen;
    if (seen) this.request();
  }

  /** Goes to a view. @param {string} name one of `VIEWS` @param {boolean} [atOnce] */
  look(name, atOnce = false) {
    this.#view = name;
    const { width, height } = this.#size;
    if (!this.#robot || !width) return;
    const box = boundsOf(this.#spec?.objects ?? [], this.#robot.bounds(), width < height);
    this.controls.go(viewOf(name, box, width / height), atOnce, performance.now());
  }

  /** Has a frame be drawn. */
  request() {
    this.#last.changed = true;
    if (this.#frame || !this.#isSeen || document.hidden) return;
    clearTimeout(this.#still);
    this.#frame = requestAnimationFrame((at) => this.#draw(at));
  }

  /** What is measured: frames of motion, and how old what they show is. */
  stats() {
    const { frames, work, late } = this.#figures;
    const middle = frames.quantile(0.5);
    return {
      fps: middle ? 1000 / middle : null,
      frame_ms: frames.spread,
      work_ms: work.spread,
      state_to_picture_ms: late.spread,
      count: frames.count,
      delay_ms: this.#joints.delayMs,
      ratio: this.#painter.ratio,
    };
  }

  /** Forgets what was measured. */
  clearStats() {
    for (const figures of Object.values(this.#figures)) figures.clear();
  }

  /** What the picture shows, for tests: where things are in it, metres and radians. */
  shown() {
    const place = new Vector3();
    const joints = {};
    for (const [name, joint] of Object.entries(this.#robot?.object.joints ?? {}))
      joints[name] = joint.jointValue[0];
    return {
      robot: this.#robot?.object.robotName ?? null,
      bodies: this.#robot?.bodies ?? 0,
      joints,
      grippers: ["left_gripper", "right_gripper"].map((link) => this.#robot?.placeOf(link) ?? null),
      objects: Array.from({ length: this.#things.count }, (_, n) =>
        this.#things.placeOf(n, place).toArray(),
      ),
      held: this.#things.held,
      trajectory: this.#course.isShown,
      view: this.#view,
      eye: this.#camera.position.toArray(),
      frames: this.#painter.renderer.info.render.frame,
    };
  }

  /**
   * Where a link would be at other joint positions, for tests.
   * @param {Record<string, number>} joints radians, by the description's names
   * @param {string} link
   */
  forward(joints, link) {
    this.#robot?.object.setJointValues(joints);
    this.request();
    return this.#robot?.placeOf(link) ?? null;
  }

  #draw(at) {
    this.#frame = 0;
    if (document.hidden || !this.#isSeen) return;
    const begun = performance.now();
    const sample = this.#joints.sample(this.link.toServer(begun));
    if (sample) this.#robot?.pose(sample.q, sample.grip);
    this.#scene.updateMatrixWorld();
    const isMoving = sample !== null && (!sample.settled || this.#isFresh(begun));
    const isBusy = [this.#things.step(at), this.controls.step(at), isMoving].some(Boolean);
    if (this.#trajectory?.began_ms != null && sample) {
      this.#course.passed((sample.atMs - this.#trajectory.began_ms) / 1000);
    }
    this.#paint(isBusy ? "moving" : "changed");
    if (sample && isMoving) this.#measure(at, begun, sample);
    this.#last.at = isBusy ? at : 0;
    if (isBusy) this.request();
    else this.#still = setTimeout(() => this.#drawFinely(), STILL_MS);
  }

  /** Whether the arm has moved of late, by messages that may come late on a slow machine. */
  #isFresh(now) {
    return now - this.#last.fresh < (this.#arm?.moving ? MOVING_MS : LINGER_MS);
  }

  #drawFinely() {
    if (this.#frame) return;
    if (!this.#isWarm && this.#robot) this.#warm();
    this.#paint("still");
  }

  /** Has everything be made that a motion needs, so that the first one does not stutter. */
  #warm() {
    this.#isWarm = true;
    this.#course.show(SPECK);
    this.#paint("moving");
    this.#course.show(this.#trajectory);
  }

  #paint(how) {
    const what = { scene: this.#scene, camera: this.#camera, room: this.#room, robot: this.#robot };
    this.#painter.draw(what, how);
    this.#label();
  }

  #measure(at, begun, sample) {
    const done = performance.now();
    if (!sample.settled) this.#figures.late.add(this.link.toServer(done) - sample.atMs);
    this.#figures.work.add(done - begun);
    if (this.#last.at === 0) return;
    this.#figures.frames.add(at - this.#last.at);
    this.#painter.learn(at - this.#last.at);
  }

  #label() {
    const point = new Vector3();
    const { width, height } = this.#size;
    const placeOf = (n) => {
      this.#things.placeOf(n, point);
      point.z += this.#things.heightOf(n) / 2 + 0.02;
      point.project(this.#camera);
      if (point.z > 1) return null;
      return { x: ((point.x + 1) / 2) * width, y: ((1 - point.y) / 2) * height };
    };
    this.overlay.place(placeOf, this.#size);
  }

  #furnish() {
    if (!this.#spec || !this.#robot) return;
    const { objects } = this.#spec;
    this.#room.setBoards(boardsUnder(objects), tableTop(objects));
  }

  /** Lights the room anew: for another theme, or because the graphics card has lost it all. */
  #mirror() {
    this.#painter.light(this.#isDark);
    this.#scene.environmentIntensity = this.#isDark ? 0.7 : 0.75;
    this.#things.setMirrored(this.#painter.mirrored);
    this.#room.setTheme(this.#isDark);
    this.#course.setTheme(this.#isDark);
    this.request();
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
