// @ts-check
import {
  CircleGeometry,
  Color,
  DirectionalLight,
  Group,
  HemisphereLight,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  ShadowMaterial,
} from "../../vendor/three/build/three.module.js";
import { box, cylinder, merged } from "./bodies.js";
import { disc } from "./glow.js";

const THICK_M = 0.024;
const LEG_M = 0.014;
const WOOD = 0xcaa676;
const PALE = 0xc6cdd4;
const STEEL = 0x9a9fa6;
/** Objects on boards that are nearer to the table's height stand on wood. */
const LEVEL_M = 0.015;

/** Colours and strengths of the light. */
const THEMES = {
  light: {
    sky: 0xffffff,
    ground: 0xc9c4bb,
    around: 1.2,
    key: 2.15,
    rim: 1.1,
    floor: 0xdfe4ea,
    shadow: 0.26,
    dim: 0.94,
  },
  dark: {
    sky: 0xaab8d0,
    ground: 0x20242c,
    around: 1.5,
    key: 2.2,
    rim: 2.2,
    floor: 0x2c333e,
    shadow: 0.5,
    dim: 0.82,
  },
};

/** Floor, light, and the boards that the objects stand on. */
export class Room {
  object = new Group();
  #sky = new HemisphereLight();
  #key = new DirectionalLight(0xfff4e6);
  #rim = new DirectionalLight(0xcfe2ff);
  #ground = new Group();
  #floor = new Mesh(
    disc([
      [0, 0.8],
      [0.5, 0.76],
      [1, 0.58],
      [1.5, 0.3],
      [1.9, 0.1],
      [2.2, 0],
    ]),
    new MeshBasicMaterial({ vertexColors: true, transparent: true, depthWrite: false }),
  );
  #shade = new Mesh(new CircleGeometry(2.4, 48), new ShadowMaterial());
  #alarm = new Mesh(
    disc([
      [0.44, 0],
      [0.46, 1],
      [0.5, 1],
      [0.52, 0.4],
      [0.9, 0],
    ]),
    new MeshBasicMaterial({
      color: 0xef4444,
      vertexColors: true,
      transparent: true,
      depthWrite: false,
    }),
  );
  #boards = new Mesh(undefined, new MeshLambertMaterial({ vertexColors: true }));

  constructor() {
    this.#key.position.set(1.6, 1.5, 3.1);
    this.#key.target.position.set(0.45, 0, 0);
    this.#key.castShadow = true;
    this.#key.shadow.bias = -0.0004;
    this.#key.shadow.normalBias = 0.012;
    this.#key.shadow.radius = 3;
    const { camera } = this.#key.shadow;
    [camera.left, camera.right, camera.bottom, camera.top] = [-1.5, 1.5, -1.5, 1.5];
    [camera.near, camera.far] = [0.5, 6];
    this.#rim.position.set(-2.4, -1.4, 1.8);
    this.#shade.receiveShadow = true;
    this.#shade.position.z = 0.001;
    this.#shade.renderOrder = -1;
    this.#floor.renderOrder = -2;
    this.#alarm.position.z = 0.004;
    this.#alarm.visible = false;
    this.#ground.add(this.#floor, this.#shade, this.#alarm);
    this.#boards.castShadow = true;
    this.#boards.receiveShadow = true;
    this.#boards.visible = false;
    this.object.add(this.#sky, this.#key, this.#key.target, this.#rim, this.#ground, this.#boards);
  }

  /** @param {number} z height of the ground, metres */
  setGround(z) {
    this.#ground.position.z = z;
  }

  /** @param {boolean} dark */
  setTheme(dark) {
    const theme = dark ? THEMES.dark : THEMES.light;
    this.#sky.color.set(theme.sky);
    this.#sky.groundColor.set(theme.ground);
    this.#sky.intensity = theme.around;
    this.#key.intensity = theme.key;
    this.#rim.intensity = theme.rim;
    this.#floor.material.color.set(theme.floor);
    this.#shade.material.opacity = theme.shadow;
    this.#boards.material.color.setScalar(theme.dim);
  }

  /** @param {number} size of the shadow's picture, pixels */
  setShadow(size) {
    if (this.#key.shadow.mapSize.x === size) return;
    this.#key.shadow.mapSize.set(size, size);
    this.#key.shadow.map?.dispose();
    this.#key.shadow.map = null;
  }

  /** Shows that motion is stopped. @param {boolean} stopped */
  setStopped(stopped) {
    this.#alarm.visible = stopped;
  }

  /**
   * Boards on legs.
   * @param {import("./boards.js").Board[]} boards
   * @param {number} table height of the one that is of wood, metres
   */
  setBoards(boards, table) {
    this.#boards.geometry.dispose();
    this.#boards.visible = boards.length > 0;
    if (boards.length === 0) return;
    const ground = this.#ground.position.z;
    this.#boards.geometry = merged(boards.flatMap((board) => furniture(board, table, ground)));
  }
}

function furniture({ low, high, top }, table, ground) {
  const paint = new Color(Math.abs(top - table) < LEVEL_M ? WOOD : PALE);
  const size = [high[0] - low[0], high[1] - low[1], THICK_M];
  const middle = [0, 1].map((k) => (low[k] + high[k]) / 2);
  const at = (x, y, z) => new Matrix4().makeTranslation(x, y, z);
  const slab = {
    geometry: box(size),
    matrix: at(middle[0], middle[1], top - THICK_M / 2),
    colour: paint,
  };
  const length = top - THICK_M - ground;
  if (length <= 0) return [slab];
  const inset = (end, to) => end + 0.12 * (to - end);
  const legs = [low, high].flatMap(([x]) =>
    [low, high].map(([, y]) => ({
      geometry: cylinder(LEG_M, length),
      matrix: at(inset(x, middle[0]), inset(y, middle[1]), ground + length / 2),
      colour: new Color(STEEL),
    })),
  );
  return [slab, ...legs];
}
