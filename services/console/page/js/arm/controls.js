// @ts-check
import { Spherical, Vector3 } from "../../vendor/three/build/three.module.js";
import { OrbitControls } from "../../vendor/three/examples/jsm/controls/OrbitControls.js";

/** Nearest and farthest distance of the camera, metres. */
const [NEAREST_M, FARTHEST_M] = [0.5, 9];
/** Largest angle of the camera from straight above, radians: a little below the horizon. */
const LOWEST_RAD = 1.62;
/** Duration of a camera move to another view, milliseconds. */
const FLIGHT_MS = 700;
/** Up is z; spherical coordinates of three have y up. */
const UPRIGHT = (v) => new Vector3(v.x, v.z, -v.y);
const LYING = (v) => new Vector3(v.x, -v.z, v.y);

/** Orbiting the camera as a person has it done, and flying it to a view. */
export class CameraControls {
  #orbit;
  /** @type {{from: any, to: any, at: number}|null} */
  #flight = null;
  /** True if a person has moved the camera from where the page put it. */
  isMoved = false;

  /**
   * @param {any} camera
   * @param {import("./pointed.js").Pointed} pointed hears what is done to the picture
   * @param {() => void} changed
   */
  constructor(camera, pointed, changed) {
    this.camera = camera;
    this.changed = changed;
    this.#orbit = new OrbitControls(camera, /** @type {any} */ (pointed));
    Object.assign(this.#orbit, {
      enableDamping: false,
      enablePan: false,
      minDistance: NEAREST_M,
      maxDistance: FARTHEST_M,
      minPolarAngle: 0.01,
      maxPolarAngle: LOWEST_RAD,
      rotateSpeed: 0.8,
    });
    this.#orbit.addEventListener("change", changed);
    this.#orbit.addEventListener("start", () => this.#take());
  }

  /**
   * Goes to a view.
   * @param {import("./cameras.js").View} view
   * @param {boolean} atOnce without a flight
   * @param {number} now milliseconds
   */
  go(view, atOnce, now) {
    const to = { eye: new Vector3(...view.eye), target: new Vector3(...view.target) };
    this.isMoved = false;
    if (atOnce) {
      this.#flight = null;
      this.#set(to.eye, to.target);
      return;
    }
    const from = { eye: this.camera.position.clone(), target: this.#orbit.target.clone() };
    this.#flight = { from, to, at: now };
    this.changed();
  }

  /**
   * Carries a flight on.
   * @param {number} now milliseconds
   * @returns {boolean} whether it continues
   */
  step(now) {
    if (!this.#flight) return false;
    const { from, to, at } = this.#flight;
    const share = Math.min((now - at) / FLIGHT_MS, 1);
    const eased = 1 - (1 - share) ** 3;
    const target = from.target.clone().lerp(to.target, eased);
    const a = new Spherical().setFromVector3(UPRIGHT(from.eye.clone().sub(from.target)));
    const b = new Spherical().setFromVector3(UPRIGHT(to.eye.clone().sub(to.target)));
    const turn = Math.atan2(Math.sin(b.theta - a.theta), Math.cos(b.theta - a.theta));
    const mixed = new Spherical(
      a.radius + (b.radius - a.radius) * eased,
      a.phi + (b.phi - a.phi) * eased,
      a.theta + turn * eased,
    ).makeSafe();
    if (share >= 1) this.#flight = null;
    this.#set(target.clone().add(LYING(new Vector3().setFromSpherical(mixed))), target);
    return this.#flight !== null;
  }

  /** Turns the picture. @param {number} theta to the side, radians @param {number} phi down */
  turn(theta, phi) {
    this.#take();
    const { target } = this.#orbit;
    const at = new Spherical().setFromVector3(UPRIGHT(this.camera.position.clone().sub(target)));
    at.theta += theta;
    at.phi = Math.min(Math.max(at.phi + phi, 0.02), LOWEST_RAD);
    this.#set(target.clone().add(LYING(new Vector3().setFromSpherical(at))), target.clone());
  }

  /** Goes nearer or farther. @param {number} factor of the distance */
  zoom(factor) {
    this.#take();
    const { target } = this.#orbit;
    const way = this.camera.position.clone().sub(target).multiplyScalar(factor);
    this.#set(target.clone().add(way.clampLength(NEAREST_M, FARTHEST_M)), target.clone());
  }

  /** From now on a person has the camera. */
  #take() {
    this.#flight = null;
    this.isMoved = true;
  }

  #set(eye, target) {
    this.camera.position.copy(eye);
    this.#orbit.target.copy(target);
    this.#orbit.update();
    this.changed();
  }
}
