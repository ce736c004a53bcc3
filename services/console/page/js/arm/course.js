// @ts-check
import {
  BufferAttribute,
  BufferGeometry,
  CatmullRomCurve3,
  Color,
  Group,
  Mesh,
  ShaderMaterial,
  Vector3,
} from "../../vendor/three/build/three.module.js";

/** Colours of the phases of a motion. */
export const PHASE_COLOURS = {
  clear: 0x8a94a6,
  approach: 0x3b82f6,
  close: 0xf59e0b,
  lift: 0x22c55e,
  hand_over: 0xf97316,
  release: 0xec4899,
  return: 0x94a3b8,
  aim: 0xa855f7,
  take: 0x3b82f6,
  carry_back: 0xf97316,
  lower: 0x22c55e,
};

const CORE_M = 0.0045;
const GLOW_M = 0.014;
const AROUND = 5;
/** Along a phase. */
const STEPS_MAX = 40;
/** A phase whose way is shorter is a place. */
const STILL_M = 0.002;

const VERTEX = `
  attribute float time;
  attribute vec3 color;
  varying float vTime;
  varying vec3 vColor;
  varying float vEdge;
  void main() {
    vTime = time;
    vColor = color;
    vec4 at = modelViewMatrix * vec4(position, 1.0);
    vec3 n = normalize(normalMatrix * normal);
    vEdge = abs(dot(n, normalize(at.xyz)));
    gl_Position = projectionMatrix * at;
  }`;

const FRAGMENT = `
  uniform float now;
  uniform float strength;
  uniform float soft;
  varying float vTime;
  varying vec3 vColor;
  varying float vEdge;
  void main() {
    float ahead = smoothstep(-0.12, 0.06, vTime - now);
    float body = mix(1.0, vEdge * vEdge, soft);
    gl_FragColor = vec4(vColor, strength * body * mix(0.16, 1.0, ahead));
    #include <colorspace_fragment>
  }`;

/** The planned way of the gripper: a line of light, faint along the part already done. */
export class CourseLine {
  object = new Group();
  #materials = [
    { strength: 1, soft: 0 },
    { strength: 0.34, soft: 1 },
  ].map(material);
  /** @type {string|null} */
  #shown = null;

  constructor() {
    this.object.visible = false;
    this.object.renderOrder = 2;
  }

  /** Returns whether a trajectory is shown. */
  get isShown() {
    return this.object.visible;
  }

  /**
   * Shows a way, or none.
   * @param {any} trajectory section `trajectory`
   */
  show(trajectory) {
    // Times may be updated for the same trajectory.
    const key = trajectory ? JSON.stringify(trajectory.phases) : null;
    if (key === this.#shown) return;
    this.#shown = key;
    for (const mesh of this.object.children) mesh.geometry.dispose();
    this.object.clear();
    const ways = (trajectory?.phases ?? []).filter(
      ({ points }) => points.length > 1 && moves(points),
    );
    this.object.visible = ways.length > 0;
    if (ways.length === 0) return;
    for (const [n, radius] of [CORE_M, GLOW_M].entries()) {
      const mesh = new Mesh(tube(ways, radius), this.#materials[n]);
      mesh.frustumCulled = false;
      this.object.add(mesh);
    }
  }

  /**
   * Moves the border between the past and the coming part.
   * @param {number} seconds since the motion began
   */
  passed(seconds) {
    for (const { uniforms } of this.#materials) uniforms.now.value = seconds;
  }

  /** On light ground the line is denser. @param {boolean} dark */
  setTheme(dark) {
    this.#materials[0].uniforms.strength.value = dark ? 0.95 : 0.9;
    this.#materials[1].uniforms.strength.value = dark ? 0.42 : 0.26;
  }
}

function material({ strength, soft }) {
  return new ShaderMaterial({
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    uniforms: { now: { value: 0 }, strength: { value: strength }, soft: { value: soft } },
    transparent: true,
    depthWrite: false,
  });
}

function moves(points) {
  const [first] = points;
  return points.some((point) => Math.hypot(...point.map((x, k) => x - first[k])) > STILL_M);
}

/** A tube round all ways, with the time and the phase's colour at each place. */
function tube(ways, radius) {
  const [positions, normals, colours, times, indices] = [[], [], [], [], []];
  for (const { name, points, t_s: seconds } of ways) {
    const curve = new CatmullRomCurve3(
      points.map((point) => new Vector3(...point)),
      false,
      "centripetal",
    );
    const steps = Math.min(points.length * 2, STEPS_MAX);
    const { normals: across, binormals } = curve.computeFrenetFrames(steps, false);
    const colour = new Color(PHASE_COLOURS[name] ?? PHASE_COLOURS.return);
    const first = positions.length / 3;
    for (let n = 0; n <= steps; n++) {
      const share = n / steps;
      // Frenet frames are spaced by length, times by the plan's own points.
      const u = curve.getUtoTmapping(share);
      const at = curve.getPoint(u);
      const time = timeAt(seconds, u);
      for (let k = 0; k < AROUND; k++) {
        const angle = (2 * Math.PI * k) / AROUND;
        const normal = new Vector3()
          .addScaledVector(across[n], Math.cos(angle))
          .addScaledVector(binormals[n], Math.sin(angle));
        positions.push(
          at.x + radius * normal.x,
          at.y + radius * normal.y,
          at.z + radius * normal.z,
        );
        normals.push(normal.x, normal.y, normal.z);
        colours.push(colour.r, colour.g, colour.b);
        times.push(time);
        if (n === steps) continue;
        const [a, b] = [first + n * AROUND + k, first + n * AROUND + ((k + 1) % AROUND)];
        indices.push(a, b, a + AROUND, b, b + AROUND, a + AROUND);
      }
    }
  }
  const geometry = new BufferGeometry();
  const set = (name, values, size) =>
    geometry.setAttribute(name, new BufferAttribute(new Float32Array(values), size));
  set("position", positions, 3);
  set("normal", normals, 3);
  set("color", colours, 3);
  set("time", times, 1);
  geometry.setIndex(indices);
  return geometry;
}

/** Seconds at a place of the curve, whose points are evenly spaced in its parameter. */
function timeAt(seconds, u) {
  const place = u * (seconds.length - 1);
  const n = Math.min(Math.floor(place), seconds.length - 2);
  return seconds[n] + (seconds[n + 1] - seconds[n]) * (place - n);
}
