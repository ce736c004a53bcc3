// @ts-check
import { Spherical, Vector3 } from "../../vendor/three/build/three.module.js";
import { OrbitControls } from "../../vendor/three/examples/jsm/controls/OrbitControls.js";

/** Turn of one press of an arrow key, radians. */
const TURN_RAD = 0.12;
const ZOOM = 1.12;
/** How long the camera takes to another view, milliseconds. */
const FLIGHT_MS = 700;
/** Up is z; spherical coordinates of three have y up. */
const UPRIGHT = (v) => new Vector3(v.x, v.z, -v.y);
const LYING = (v) => new Vector3(v.x, -v.z, v.y);

/** Orbiting the camera by mouse, touch and keyboard, and flying it to a view. */
export class CameraControls {
  #orbit;
  /** @type {{from: any, to: any, at: number}|null} */
  #flight = null;
  /** Whether a person has moved the camera from where the page put it. */
  isMoved = false;

  /**
   * @param {any} camera
   * @param {HTMLElement} stage takes the keys
   * @param {HTMLCanvasElement} canvas
   * @param {() => void} changed
   */
  constructor(camera, stage, canvas, changed) {
    this.camera = camera;
    this.changed = changed;
    this.#orbit = new OrbitControls(camera, canvas);
    Object.assign(this.#orbit, {
      enableDamping: false,
      enablePan: false,
      minDistance: 0.5,
      maxDistance: 9,
      minPolarAngle: 0.01,
      maxPolarAngle: 1.62,
      rotateSpeed: 0.8,
    });
    // A finger that moves up and down scrolls the page; to the side it turns the picture.
    canvas.style.setProperty("touch-action", "pan-y");
    this.#orbit.addEventListener("change", changed);
    this.#orbit.addEventListener("start", () => {
      this.#flight = null;
      this.isMoved = true;
    });
    stage.addEventListener("keydown", (event) => this.#key(event));
    // The wheel scrolls the page until the picture was chosen.
    const chosen = () => stage.contains(document.activeElement);
    stage.addEventListener("wheel", (event) => chosen() || event.stopPropagation(), {
      capture: true,
    });
  }

  /**
   * Goes to a view.
   * @param {import("./cameras.js").View} view
   * @param {boolean} atOnce without a flight
   * @param {number} now page time, milliseconds
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
   * @param {number} now page time, milliseconds
   * @returns {boolean} whether it goes on
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

  dispose() {
    this.#orbit.dispose();
  }

  #set(eye, target) {
    this.camera.position.copy(eye);
    this.#orbit.target.copy(target);
    this.#orbit.update();
    this.changed();
  }

  #key(event) {
    const steps = {
      ArrowLeft: () => this.#turn(-TURN_RAD, 0),
      ArrowRight: () => this.#turn(TURN_RAD, 0),
      ArrowUp: () => this.#turn(0, -TURN_RAD),
      ArrowDown: () => this.#turn(0, TURN_RAD),
      "+": () => this.#zoom(1 / ZOOM),
      "=": () => this.#zoom(1 / ZOOM),
      "-": () => this.#zoom(ZOOM),
    };
    if (event.ctrlKey || event.metaKey || event.altKey || !steps[event.key]) return;
    event.preventDefault();
    event.stopPropagation();
    this.#flight = null;
    this.isMoved = true;
    steps[event.key]();
  }

  #turn(theta, phi) {
    const { target } = this.#orbit;
    const at = new Spherical().setFromVector3(UPRIGHT(this.camera.position.clone().sub(target)));
    at.theta += theta;
    at.phi = Math.min(Math.max(at.phi + phi, 0.02), 1.62);
    this.#set(target.clone().add(LYING(new Vector3().setFromSpherical(at))), target.clone());
  }

  #zoom(factor) {
    const { target } = this.#orbit;
    const way = this.camera.position.clone().sub(target).multiplyScalar(factor).clampLength(0.5, 9);
    this.#set(target.clone().add(way), target.clone());
  }
}
