// @ts-check
import { Vector3 } from "../../vendor/three/build/three.module.js";
import { limbNames } from "./joints.js";

/** Queries and actions on the picture for tests. */
export class Questions {
  #view;

  /** @param {import("./view.js").ArmView} view */
  constructor(view) {
    this.#view = view;
  }

  /** Measurements: frames of motion, and the age of the data that they show. */
  stats() {
    const { figures, joints, painter } = this.#view;
    return { ...figures.all, delay_ms: joints.delayMs, ratio: painter.ratio };
  }

  /** Forgets the measurements. */
  clearStats() {
    this.#view.figures.clear();
  }

  /** Contents of the picture: places of things, metres and radians. */
  shown() {
    const { tableau, camera, painter, viewName } = this.#view;
    const { robot, things, course } = tableau;
    const values = Object.entries(robot?.object.joints ?? {});
    return {
      robot: robot?.object.robotName ?? null,
      bodies: robot?.bodies ?? 0,
      joints: Object.fromEntries(values.map(([name, joint]) => [name, joint.jointValue[0]])),
      grippers: limbNames(robot?.object ?? { links: {} }).map(
        (limb) => robot?.placeOf(`${limb}_gripper`) ?? null,
      ),
      objects: Array.from({ length: things.count }, (_, n) =>
        things.placeOf(n, new Vector3()).toArray(),
      ),
      held: things.held,
      trajectory: course.isShown,
      view: viewName,
      eye: camera.position.toArray(),
      frames: painter.renderer.info.render.frame,
      thread: globalThis.document ? "page" : "worker",
    };
  }

  /**
   * Returns a link's pose at other joint positions.
   * @param {Record<string, number>} joints radians, by the description's names
   * @param {string} link
   */
  forward(joints, link) {
    const { robot } = this.#view.tableau;
    robot?.object.setJointValues(joints);
    this.#view.request();
    return robot?.placeOf(link) ?? null;
  }

  /** Does nothing, for so long. @param {number} ms */
  spin(ms) {
    for (const end = performance.now() + ms; performance.now() < end; );
  }

  /** Takes the graphics card away. */
  lose() {
    this.#view.painter.renderer.forceContextLoss();
  }

  /** Gives it back. */
  restore() {
    this.#view.painter.renderer.forceContextRestore();
  }
}
