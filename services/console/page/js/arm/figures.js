// @ts-check
/** Values that are kept. */
const KEPT = 600;

/** The latest values of something that is measured. */
export class Rolling {
  /** @type {number[]} */
  #values = [];
  /** Number of samples so far. */
  count = 0;

  /** @param {number} value */
  add(value) {
    this.count += 1;
    this.#values.push(value);
    if (this.#values.length > KEPT) this.#values.shift();
  }

  /** Forgets everything. */
  clear() {
    this.#values = [];
    this.count = 0;
  }

  /**
   * The value below which a share of all is.
   * @param {number} share of one
   * @returns {number|null} null while there is none
   */
  quantile(share) {
    const sorted = [...this.#values].sort((a, b) => a - b);
    return sorted.length ? sorted[Math.round(share * (sorted.length - 1))] : null;
  }

  /** Median and 99th percentile. */
  get spread() {
    return { p50: this.quantile(0.5), p99: this.quantile(0.99) };
  }
}

/** Measurements of a moving picture. */
export class MotionFigures {
  #frames = new Rolling();
  #work = new Rolling();
  #late = new Rolling();

  /**
   * @param {object} frame milliseconds each; what is null does not count
   * @param {number|null} frame.interval since the frame before
   * @param {number} frame.work that drawing took
   * @param {number|null} frame.late from the state of the joints to the picture of it
   */
  add({ interval, work, late }) {
    if (interval !== null) this.#frames.add(interval);
    this.#work.add(work);
    if (late !== null) this.#late.add(late);
  }

  /** Forgets everything. */
  clear() {
    for (const figures of [this.#frames, this.#work, this.#late]) figures.clear();
  }

  /** Frame rate, time per frame, and age of the data shown. */
  get all() {
    const middle = this.#frames.quantile(0.5);
    return {
      fps: middle ? 1000 / middle : null,
      frame_ms: this.#frames.spread,
      work_ms: this.#work.spread,
      state_to_picture_ms: this.#late.spread,
      count: this.#frames.count,
    };
  }
}

/** Frames slower than this make the picture coarser, milliseconds. */
const SLOW_MS = 19;
/** Frames slower than this make it coarser sooner. */
const CRAWLING_MS = 45;
/** Frames that are judged together: usually, and where they crawl. */
const JUDGED = { usually: 20, crawling: 4 };
/** Judgements without a slow one before a finer picture is tried. */
const PATIENCE = { first: 12, most: 400 };

/**
 * Level of detail of a moving picture, chosen so that it keeps up with the screen. Of several
 * levels, 0 is the finest.
 */
export class Fineness {
  #calm = 0;
  #patience = PATIENCE.first;
  /** @type {number[]} */
  #intervals = [];

  /** @param {number} levels @param {number} level the first one */
  constructor(levels, level) {
    this.levels = levels;
    this.level = level;
  }

  /**
   * Takes a frame.
   * @param {number} intervalMs since the frame before
   * @returns {boolean} whether the level has changed
   */
  add(intervalMs) {
    this.#intervals.push(intervalMs);
    const many = this.#intervals.length;
    const middle = [...this.#intervals].sort((a, b) => a - b)[many >> 1];
    const crawls = many >= JUDGED.crawling && middle > CRAWLING_MS;
    if (!crawls && many < JUDGED.usually) return false;
    this.#intervals = [];
    const before = this.level;
    if (middle > SLOW_MS) {
      this.level = Math.min(this.level + 1, this.levels - 1);
      this.#calm = 0;
    } else if (++this.#calm > this.#patience) {
      // Finer may be too much again; then it takes longer until the next try.
      this.level = Math.max(this.level - 1, 0);
      this.#calm = 0;
      this.#patience = Math.min(this.#patience * 2, PATIENCE.most);
    }
    return this.level !== before;
  }
}
