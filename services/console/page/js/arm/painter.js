// @ts-check
import {
  NoToneMapping,
  PCFShadowMap,
  Vector2,
  WebGLRenderer,
} from "../../vendor/three/build/three.module.js";
import { Fineness } from "./figures.js";
import { studio } from "./studio.js";

/**
 * Levels of detail of a moving picture, finest first: its most pixels, the pixels along a side of
 * its shadows, and whether the robot mirrors the room.
 */
const FINENESS = [
  { pixels: 8e6, shadow: 2048, rich: true },
  { pixels: 2e6, shadow: 1024, rich: true },
  { pixels: 1e6, shadow: 1024, rich: false },
  { pixels: 4e5, shadow: 512, rich: false },
  { pixels: 2e5, shadow: 512, rich: false },
  { pixels: 9e4, shadow: 256, rich: false },
];
/** First level if the processor draws. */
const FIRST_IN_SOFTWARE = 3;
/** Names of renderers that have no graphics card. */
const SOFTWARE = /swiftshader|llvmpipe|softpipe|basic render|software/i;
/** Pixels of the picture per pixel of the page at most. */
const RATIO_MAX = 2;
/** Strength of the light that the studio throws on everything. */
const STUDIO_LIGHT = { light: 0.75, dark: 0.7 };

/** Draws a scene as finely as this machine can while it moves, and finely when still. */
export class Painter {
  #fineness;
  #isSoftware;
  /** Texture that shiny things mirror, once something has been drawn. @type {any} */
  #studio = null;
  #isDark = false;
  #size = { width: 0, height: 0, screen: 1 };
  #isOdd = false;

  /** @param {HTMLCanvasElement|OffscreenCanvas} canvas */
  constructor(canvas) {
    this.#isSoftware = SOFTWARE.test(rendererName());
    this.#fineness = new Fineness(FINENESS.length, this.#isSoftware ? FIRST_IN_SOFTWARE : 0);
    this.renderer = new WebGLRenderer({ canvas, alpha: true, antialias: !this.#isSoftware });
    this.renderer.toneMapping = NoToneMapping;
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
  }

  /** Pixels of the picture per pixel of the page while it moves. */
  get ratio() {
    const { width, height, screen } = this.#size;
    const { pixels } = FINENESS[this.#fineness.level];
    return Math.min(Math.sqrt(pixels / Math.max(width * height, 1)), screen, RATIO_MAX);
  }

  /**
   * @param {{width: number, height: number, screen: number}} size pixels of the page, and pixels of
   *   the screen per pixel of the page
   */
  setSize(size) {
    this.#size = size;
  }

  /** Renders the environment map again. @param {boolean} dark */
  light(dark) {
    this.#isDark = dark;
    this.#studio?.dispose();
    this.#studio = null;
  }

  /**
   * Draws.
   * @param {import("./tableau.js").Tableau} tableau
   * @param {any} camera
   * @param {"still"|"moving"|"changed"} how a still picture is drawn finely; one that has changed
   *   once, and one that moves, quickly
   */
  draw(tableau, camera, how) {
    const { shadow, rich } = FINENESS[how === "still" ? 0 : this.#fineness.level];
    this.#studio ??= studio(this.#isDark);
    const { scene } = tableau;
    scene.environment = rich ? this.#studio : null;
    scene.environmentIntensity = this.#isDark ? STUDIO_LIGHT.dark : STUDIO_LIGHT.light;
    tableau.setFineness({ shadow, rich, mirrored: this.#studio });
    this.#resize(how === "still" ? this.#finest() : this.ratio);
    // Without a graphics card the shadows of moving things follow at half the rate.
    this.#isOdd = !this.#isOdd;
    this.renderer.shadowMap.autoUpdate = rich;
    this.renderer.shadowMap.needsUpdate = this.#isOdd || how !== "moving";
    this.renderer.render(scene, camera);
  }

  /** Takes how long a frame of motion took. @param {number} intervalMs */
  learn(intervalMs) {
    this.#fineness.add(intervalMs);
  }

  /** Without a graphics card edges are smoothed by drawing still pictures twice as large. */
  #finest() {
    return this.#isSoftware ? RATIO_MAX : Math.min(this.#size.screen, RATIO_MAX);
  }

  #resize(ratio) {
    const { width, height } = this.#size;
    if (this.renderer.getPixelRatio() !== ratio) this.renderer.setPixelRatio(ratio);
    const { x, y } = this.renderer.getSize(new Vector2());
    if (x !== width || y !== height) this.renderer.setSize(width, height, false);
  }
}

/** Name of the renderer: a graphics card, or software. */
function rendererName() {
  const canvas = globalThis.document?.createElement("canvas") ?? new OffscreenCanvas(1, 1);
  const gl = /** @type {any} */ (canvas.getContext("webgl2"));
  if (!gl) throw new Error("no WebGL");
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  const name = gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER);
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return String(name);
}
