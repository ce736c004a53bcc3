// @ts-check
/** Spacing of the finest places, metres. */
export const CELL_M = 0.05;
/** Spacings in cells: all coarse places are requested, finer ones only if the answer changes. */
const LEVELS = [4, 2, 1];
/** The places in cells: x from, to, y from, to. */
const AREA = [-4, 28, -28, 28];
/** Places of one request. */
const BATCH = 48;

/**
 * Properties of an object on which its reach depends.
 * @param {any} object
 * @returns {string} "" for one without a place
 */
export function reachKey(object) {
  const { xyz, size, yaw, grasp_width, mass_kg, form, wall_deg } = object ?? {};
  if (!xyz || !size || !grasp_width) return "";
  return JSON.stringify([xyz[2], size, yaw ?? 0, grasp_width, mass_kg ?? 0, form, wall_deg ?? 0]);
}

/**
 * Places where the arm can fetch a lone object, by few requests.
 */
export class ReachMap {
  /** @type {Map<string, string|null>} limb by place in cells; null: none */
  #known = new Map();
  isComplete = false;
  /** Why there is a place that no limb can fetch it from. @type {string|null} */
  why = null;

  /**
   * Asks for places until the map is complete.
   * @param {any} object
   * @param {(object: any, at: number[][]) => Promise<{limbs: (string|null)[], why: string|null}>} ask
   *   answers for the first places at least
   * @param {() => void} onChange
   */
  async fill(object, ask, onChange) {
    for (const level of LEVELS) {
      let wanted = this.#wanted(level, object.xyz);
      while (wanted.length > 0) {
        const batch = wanted.slice(0, BATCH);
        const at = batch.map((place) => place.map((n) => n * CELL_M));
        const { limbs, why } = await ask(object, at);
        this.why ??= why;
        for (const [k, limb] of limbs.entries()) this.#known.set(String(batch[k]), limb);
        if (limbs.length === 0) return;
        wanted = wanted.slice(limbs.length);
        onChange();
      }
    }
    this.isComplete = true;
    onChange();
  }

  /** The places of a level that are not known and not clear, the nearest to the object first. */
  #wanted(level, [x, y]) {
    const [fromX, toX, fromY, toY] = AREA;
    const places = [];
    for (let i = fromX; i <= toX; i += level) {
      for (let k = fromY; k <= toY; k += level) {
        if (!this.#known.has(`${i},${k}`) && this.#isOpen(i, k, level)) places.push([i, k]);
      }
    }
    const far = ([i, k]) => Math.hypot(i * CELL_M - x, k * CELL_M - y);
    return places.sort((a, b) => far(a) - far(b));
  }

  /** Returns whether the coarser places around one differ. */
  #isOpen(i, k, level) {
    if (level === LEVELS[0]) return true;
    const step = 2 * level;
    const around = (n) => [Math.floor(n / step) * step, Math.ceil(n / step) * step];
    const limbs = around(i).flatMap((a) => around(k).map((b) => this.#cell(a, b)));
    return new Set(limbs.map((limb) => (limb === undefined ? "" : limb !== null))).size > 1;
  }

  /** The answer for a place in cells, or for the nearest one that was asked for. */
  #cell(i, k) {
    for (const level of [...LEVELS].reverse()) {
      const key = [i, k].map((n) => Math.round(n / level) * level + 0).join();
      if (this.#known.has(key)) return this.#known.get(key);
    }
    return undefined;
  }

  /**
   * The limb that can fetch the object at a place; null: none, undefined: not known yet. Beyond the map it is as
   * at its edge.
   * @param {number} x metres
   * @param {number} y
   */
  at(x, y) {
    const [fromX, toX, fromY, toY] = AREA;
    const cell = (m, from, to) => Math.min(Math.max(Math.round(m / CELL_M), from), to);
    return this.#cell(cell(x, fromX, toX), cell(y, fromY, toY));
  }

  /**
   * The stretches of places with one answer, row by row.
   * @returns {{x: number, from: number, to: number, limb: string|null}[]} metres; from y to y
   */
  stretches() {
    const [fromX, toX, fromY, toY] = AREA;
    const all = [];
    for (let i = fromX; i <= toX; i++) {
      let begun = fromY;
      for (let k = fromY; k <= toY + 1; k++) {
        const limb = this.#cell(i, begun);
        if (k <= toY && this.#cell(i, k) === limb) continue;
        if (limb !== undefined) {
          const [from, to] = [(begun - 0.5) * CELL_M, (k - 0.5) * CELL_M];
          all.push({ x: i * CELL_M, from, to, limb });
        }
        begun = k;
      }
    }
    return all;
  }
}
