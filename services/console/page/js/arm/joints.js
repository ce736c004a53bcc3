// @ts-check
/** Names of the joints in the order of the server's `joints` messages: `JOINT_STATE_NAMES`. */
export const JOINT_NAMES = [
  "head_nod",
  "head_pan",
  ..."e0 e1 s0 s1 w0 w1 w2".split(" ").map((joint) => `left_${joint}`),
  ..."e0 e1 s0 s1 w0 w1 w2".split(" ").map((joint) => `right_${joint}`),
  "torso_t0",
];

/** A limb's joints from the trunk to the hand. */
export const LIMB_JOINTS = ["s0", "s1", "e0", "e1", "w0", "w1", "w2"];

/** Both limbs, in the order in which the server lists what there is of each. */
export const LIMBS = ["left", "right"];

/**
 * Names of the limbs: both, or that of the only one. The link at a limb's end is `NAME_gripper`.
 * @param {{links: Record<string, any>}} robot
 * @returns {string[]}
 */
export function limbNames(robot) {
  if (LIMBS.some((limb) => robot.links[`${limb}_gripper`])) return LIMBS;
  const ends = Object.keys(robot.links).filter((link) => link.endsWith("_gripper"));
  return ends.slice(0, 1).map((link) => link.slice(0, -"_gripper".length));
}

/** Messages that are kept. */
const KEPT = 40;
/** Gap between messages that are not a stream: the arm rested in between. */
const STREAM_MS = 120;
/** Messages whose delays are judged. */
const JUDGED = 24;
/** Bounds of how far the picture is behind the server's clock. */
const DELAY_MS = { least: 20, most: 300, first: 45 };
/** Largest change of the delay per message, small enough to be invisible. */
const SLEW_MS = { up: 6, down: 2 };
/** A message older than the last by more than this is of another life of the server. */
const AGAIN_MS = 1_000;

/**
 * @typedef {object} Sample
 * @property {number[]} q radians, in the order of `JOINT_NAMES`
 * @property {number[]} grip opening of the left and right gripper, percent
 * @property {number} atMs server time at which the joints were so
 * @property {boolean} settled whether nothing newer waits to be shown
 */

/**
 * Joint states on their way to the picture. It is drawn a little behind the server's clock, so that
 * there is a message before and one after each instant and motion is smooth whatever the network
 * does; how little is learnt from the messages themselves.
 */
export class JointBuffer {
  /** @type {{at_ms: number, q: number[], grip: number[]}[]} */
  #states = [];
  /** @type {{late: number, gap: number}[]} */
  #seen = [];
  #shownMs = Number.NEGATIVE_INFINITY;
  /** Delay of the picture behind the server's clock, milliseconds. */
  delayMs = DELAY_MS.first;

  /** The newest state, if any. */
  get latest() {
    return this.#states.at(-1);
  }

  /**
   * Takes a message.
   * @param {{at_ms: number, q: number[], grip: number[]}} message
   * @param {number} nowMs server time of its arrival
   * @returns {boolean} whether it says anything new
   */
  add(message, nowMs) {
    const last = this.latest;
    if (last && message.at_ms < last.at_ms - AGAIN_MS) this.#forget();
    else if (last && message.at_ms <= last.at_ms) return false;
    const gap = last ? message.at_ms - last.at_ms : Number.POSITIVE_INFINITY;
    if (last && gap > STREAM_MS) this.#stoodUntil(message.at_ms, last);
    this.#states.push({ at_ms: message.at_ms, q: message.q, grip: message.grip });
    if (this.#states.length > KEPT) this.#states.splice(0, this.#states.length - KEPT);
    if (gap <= STREAM_MS) this.#judge(nowMs - message.at_ms, gap);
    return !last || !same(last, message);
  }

  /**
   * The joints as they are to be drawn.
   * @param {number} nowMs server time
   * @returns {Sample|null} null before the first message
   */
  sample(nowMs) {
    const last = this.latest;
    if (!last) return null;
    // A delay that grows must not turn the motion back.
    const at = Math.max(nowMs - this.delayMs, this.#shownMs);
    this.#shownMs = Math.min(at, last.at_ms);
    if (at >= last.at_ms) return { q: last.q, grip: last.grip, atMs: last.at_ms, settled: true };
    const next = this.#states.findIndex((state) => state.at_ms > at);
    const after = this.#states[next];
    const before = this.#states[Math.max(next - 1, 0)];
    const span = after.at_ms - before.at_ms;
    const share = span > 0 ? Math.max(at - before.at_ms, 0) / span : 1;
    const mix = (a, b) => a.map((value, n) => value + (b[n] - value) * share);
    return {
      q: mix(before.q, after.q),
      grip: mix(before.grip, after.grip),
      atMs: at,
      settled: false,
    };
  }

  #forget() {
    this.#states = [];
    this.#seen = [];
    this.#shownMs = Number.NEGATIVE_INFINITY;
  }

  /** The arm has rested since the last message, which came at the slow rate of rest. */
  #stoodUntil(atMs, last) {
    this.#states.push({ ...last, at_ms: atMs - STREAM_MS / 4 });
  }

  #judge(late, gap) {
    this.#seen.push({ late, gap });
    if (this.#seen.length > JUDGED) this.#seen.shift();
    const lates = this.#seen.map((seen) => seen.late).sort((a, b) => a - b);
    const gaps = this.#seen.map((seen) => seen.gap).sort((a, b) => a - b);
    const at = (sorted, share) => sorted[Math.floor(share * (sorted.length - 1))];
    const wanted = Math.min(
      Math.max(at(lates, 0.9) + at(gaps, 0.75), DELAY_MS.least),
      DELAY_MS.most,
    );
    const change = Math.min(Math.max(wanted - this.delayMs, -SLEW_MS.down), SLEW_MS.up);
    this.delayMs += change;
  }
}

function same(a, b) {
  const equal = (x, y) => x.every((value, n) => Math.abs(value - y[n]) < 1e-6);
  return equal(a.q, b.q) && equal(a.grip, b.grip);
}

/**
 * Returns the position of a finger's joint.
 * @param {{lower: number, upper: number}} limit metres or radians
 * @param {number} percent opening of the gripper
 * @returns {number} closed nearest to zero, open farthest from it
 */
export function fingerPosition({ lower, upper }, percent) {
  const [near, far] = Math.abs(lower) <= Math.abs(upper) ? [lower, upper] : [upper, lower];
  return near + ((far - near) * Math.min(Math.max(percent, 0), 100)) / 100;
}
