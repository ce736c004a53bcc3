// @ts-check
import { PerspectiveCamera } from "../../vendor/three/build/three.module.js";
import { boundsOf, FIELD_DEG, viewOf } from "./cameras.js";
import { CameraControls } from "./controls.js";
import { MotionFigures } from "./figures.js";
import { JointBuffer } from "./joints.js";
import { objectBoxes } from "./labels.js";
import { Loop } from "./loop.js";
import { Painter } from "./painter.js";
import { Pointed } from "./pointed.js";
import { Tableau } from "./tableau.js";

/** The picture is drawn for this long after the last joint states: the next ones may be late. */
const LINGER_MS = 250;
/** The same while the arm says that it moves. */
const MOVING_MS = 2_000;

/** The picture. Draws only when something changes and it is visible. */
export class ArmView {
  tableau = new Tableau();
  camera = new PerspectiveCamera(FIELD_DEG, 1, 0.05, 30);
  joints = new JointBuffer();
  figures = new MotionFigures();
  /** Which of the views the camera was sent to last. */
  viewName = "start";
  #pointed = new Pointed();
  #say;
  #said = "";
  #isDark = false;
  #isSeen = false;
  #isLost = false;
  #isWarm = false;
  #loop = new Loop({
    isShown: () => this.#isSeen && !this.#isLost && this.#size.width > 0,
    draw: (at) => this.#draw(at),
    drawFinely: () => this.#drawFinely(),
  });
  /** When the last frame of a motion was, 0 for none; when the arm has moved last. */
  #last = { frame: 0, fresh: Number.NEGATIVE_INFINITY };
  #size = { width: 0, height: 0 };
  /** Offset of the server's clock from `performance.timeOrigin + performance.now()`. */
  #clockMs = 0;

  /**
   * @param {HTMLCanvasElement|OffscreenCanvas} canvas
   * @param {(message: object) => void} say notifies the page of a new `picture`: the objects' boxes,
   *   the held object, whether it has a robot and is fine; or that the graphics card is `lost`
   */
  constructor(canvas, say) {
    this.#say = say;
    this.painter = new Painter(canvas);
    this.camera.up.set(0, 0, 1);
    this.controls = new CameraControls(this.camera, this.#pointed, () => this.request());
    canvas.addEventListener("webglcontextlost", () => this.#lose());
    canvas.addEventListener("webglcontextrestored", () => this.#restore());
    this.#light();
  }

  /** @param {import("./elements.js").Tree} description the robot's URDF */
  setRobot(description) {
    this.tableau.setRobot(description, this.joints.latest);
    this.look("start", true);
    this.request();
  }

  /** @param {any} spec section `scene` */
  setScene(spec) {
    this.tableau.setScene(spec);
    this.#said = "";
    this.#lookAgain();
    this.request();
  }

  /** @param {any} world section `world` */
  setWorld(world) {
    this.tableau.setWorld(world);
    this.request();
  }

  /** @param {any} trajectory section `trajectory` */
  setTrajectory(trajectory) {
    this.tableau.setTrajectory(trajectory);
    this.request();
  }

  /** @param {{belief: number|null, best: boolean, asked: boolean}[]} thoughts in the scene's order */
  setThoughts(thoughts) {
    this.tableau.setThoughts(thoughts);
    this.request();
  }

  /** @param {any} arm section `arm` */
  setArm(arm) {
    this.tableau.setArm(arm);
    this.request();
  }

  /**
   * @param {{at_ms: number, q: number[], grip: number[]}} message
   * @param {number} arrivedMs server time at which the page got it: what waits here for a frame to be
   *   drawn is there in time for the next one
   * @param {number} clockMs lead of the server's clock over the one that all threads of the
   *   browser share: `performance.timeOrigin + performance.now()`
   */
  setJoints(message, arrivedMs, clockMs) {
    this.#clockMs = clockMs;
    const now = performance.now();
    const isFirst = this.joints.latest === undefined;
    if (this.joints.add(message, arrivedMs)) this.#last.fresh = now;
    if (this.#isFresh(now)) this.request();
    if (!isFirst) return;
    // The camera's distance depends on the arms' postures.
    this.tableau.robot?.pose(message.q, message.grip);
    this.#lookAgain();
  }

  /** @param {boolean} dark */
  setTheme(dark) {
    if (dark === this.#isDark) return;
    this.#isDark = dark;
    this.#light();
  }

  /** @param {{width: number, height: number, screen: number}} size see `Painter` */
  setSize(size) {
    this.#size = size;
    this.camera.aspect = size.width / size.height;
    this.camera.updateProjectionMatrix();
    this.painter.setSize(size);
    Object.assign(this.#pointed, { clientWidth: size.width, clientHeight: size.height });
    this.#lookAgain();
    this.request();
  }

  /** Pauses or resumes drawing with the picture's visibility. @param {boolean} seen */
  setSeen(seen) {
    this.#isSeen = seen;
    this.request();
  }

  /** See `Pointed`. @param {string} type @param {object} fields */
  happen(type, fields) {
    this.#pointed.happen(type, fields);
  }

  /** See `CameraControls`. @param {number} theta @param {number} phi */
  turn(theta, phi) {
    this.controls.turn(theta, phi);
  }

  /** See `CameraControls`. @param {number} factor */
  zoom(factor) {
    this.controls.zoom(factor);
  }

  /** Goes to a view. @param {string} name one of `VIEWS` @param {boolean} [atOnce] */
  look(name, atOnce = false) {
    this.viewName = name;
    const { width, height } = this.#size;
    const { robot, objects } = this.tableau;
    if (!robot || !width) return;
    const box = boundsOf(objects, robot.bounds(), width < height);
    this.controls.go(viewOf(name, box, width / height), atOnce, performance.now());
  }

  /** Frames the camera on a new region, unless a person has moved it. */
  #lookAgain() {
    if (!this.controls.isMoved) this.look(this.viewName, true);
  }

  /** Has a frame be drawn. */
  request() {
    this.#loop.request();
  }

  /** @param {number} at milliseconds @returns {boolean} whether anything still moves */
  #draw(at) {
    const begun = performance.now();
    const sample = this.joints.sample(this.#toServer(begun));
    const isMoving = sample !== null && (!sample.settled || this.#isFresh(begun));
    const isBusy = [this.tableau.step(at, sample), this.controls.step(at), isMoving].some(Boolean);
    this.#paint(isBusy ? "moving" : "changed");
    if (sample && isMoving) this.#measure(at, begun, sample);
    this.#last.frame = isBusy ? at : 0;
    return isBusy;
  }

  #drawFinely() {
    // Resources of a motion are made before the first one, lest it stutter.
    if (!this.#isWarm && this.tableau.robot) this.tableau.withSpeck(() => this.#paint("moving"));
    this.#isWarm ||= this.tableau.robot !== null;
    this.#paint("still");
  }

  #paint(how) {
    this.painter.draw(this.tableau, this.camera, how);
    const picture = {
      boxes: objectBoxes(this.tableau.things, this.camera, this.#size),
      held: this.tableau.things.held,
      robot: this.tableau.robot !== null,
      fine: how === "still",
    };
    const said = JSON.stringify(picture);
    if (said === this.#said) return;
    this.#said = said;
    this.#say({ picture });
  }

  #measure(at, begun, sample) {
    const done = performance.now();
    const interval = this.#last.frame ? at - this.#last.frame : null;
    const late = sample.settled ? null : this.#toServer(done) - sample.atMs;
    this.figures.add({ interval, work: done - begun, late });
    if (interval !== null) this.painter.learn(interval);
  }

  /** Returns whether the arm has moved recently; messages may be late on a slow machine. */
  #isFresh(now) {
    return now - this.#last.fresh < (this.tableau.isMoving ? MOVING_MS : LINGER_MS);
  }

  /** @param {number} ms of `performance.now()` here */
  #toServer(ms) {
    return performance.timeOrigin + ms + this.#clockMs;
  }

  #light() {
    this.painter.light(this.#isDark);
    this.tableau.setTheme(this.#isDark);
    this.request();
  }

  #lose() {
    this.#isLost = true;
    this.#said = "";
    this.#say({ lost: true });
  }

  /** The graphics card has forgotten everything. */
  #restore() {
    this.#isLost = false;
    this.#isWarm = false;
    this.#light();
  }
}
