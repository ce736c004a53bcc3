// @ts-check
/**
 * @typedef {object} Wish of a label
 * @property {number} x its middle, pixels
 * @property {number} y its foot
 * @property {number} width
 * @property {number} height
 * @property {number} weight the heavier goes first
 */

/** Space between two labels. */
const GAP = 3;
/** In a picture that is narrower only what matters is labelled. */
const NARROW = 480;
/** Largest upward shift of a label to find room, in label heights. */
const STEPS = [0, 1, 2, -1.9];

/**
 * Places for labels that do not cover each other.
 * @param {Wish[]} wishes
 * @param {{width: number, height: number}} frame
 * @returns {({x: number, y: number}|null)[]} left upper corners; null where there is no room
 */
export function placeLabels(wishes, frame) {
  const taken = [];
  const places = wishes.map(() => null);
  const order = wishes.map((_, n) => n).sort((a, b) => wishes[b].weight - wishes[a].weight);
  for (const n of order) {
    const { x, y, width, height } = wishes[n];
    for (const step of STEPS) {
      const at = { x: x - width / 2, y: y - height - step * (height + GAP), width, height };
      at.x = Math.min(Math.max(at.x, GAP), frame.width - width - GAP);
      const inside = at.x >= 0 && at.y >= 0 && at.y + height <= frame.height;
      if (!inside || taken.some((other) => covers(at, other))) continue;
      taken.push(at);
      places[n] = { x: at.x, y: at.y };
      break;
    }
  }
  return places;
}

function covers(a, b) {
  const apart = (at, long) => at < long + GAP;
  const overX = apart(a.x - b.x, b.width) && apart(b.x - a.x, a.width);
  return overX && apart(a.y - b.y, b.height) && apart(b.y - a.y, a.height);
}

/** Names of the objects over the picture. */
export class Overlay {
  /** @type {{node: HTMLElement, share: HTMLElement, width: number, height: number, weight: number}[]} */
  #labels = [];
  /** @type {{belief: number|null, best: boolean, asked: boolean}[]} */
  #thoughts = [];
  /** Which object is in the gripper, -1 for none. */
  #held = -1;
  /**
   * Places of the objects in the picture; null: not visible.
   * @type {({x: number, y: number}|null)[]}
   */
  #places = [];
  #frame = { width: 0, height: 0 };

  /** @param {HTMLElement} list */
  constructor(list) {
    this.list = list;
  }

  /** @param {any} scene section `scene` */
  setScene(scene) {
    this.#labels = scene.objects.map(({ label, name }) => {
      const node = document.createElement("li");
      const text = document.createElement("span");
      const share = document.createElement("span");
      text.textContent = label ?? name;
      share.className = "arm-share";
      node.className = "arm-label";
      node.append(text, share);
      return { node, share, width: 0, height: 0, weight: 0 };
    });
    this.#places = [];
    this.list.replaceChildren(...this.#labels.map(({ node }) => node));
    this.#measure();
    this.#mark();
  }

  /** @param {{belief: number|null, best: boolean, asked: boolean}[]} thoughts */
  setThoughts(thoughts) {
    this.#thoughts = thoughts;
    this.#mark();
  }

  /** @param {{width: number, height: number}} frame of the picture */
  setSize(frame) {
    this.#frame = frame;
    this.#measure();
  }

  /**
   * Puts the labels over what they name.
   * @param {({x: number, y: number}|null)[]} places in the picture; null: not seen
   * @param {number} held which object is in the gripper, -1 for none
   */
  place(places, held) {
    this.#places = places;
    if (held === this.#held) return this.#place();
    this.#held = held;
    this.#mark();
  }

  #mark() {
    let isOther = false;
    for (const [n, label] of this.#labels.entries()) {
      const { belief = null, best = false, asked = false } = this.#thoughts[n] ?? {};
      const isHeld = n === this.#held;
      const percent = belief === null ? "" : ` ${Math.round(100 * belief)} %`;
      const mark = isHeld ? "held" : asked ? "asked" : best ? "best" : "";
      label.weight = (isHeld ? 4 : 0) + (asked ? 2 : 0) + (best ? 1 : 0) + (belief ?? 0);
      label.node.dataset.faint = String(belief !== null && belief < 0.02 && !isHeld);
      if (label.share.textContent === percent && label.node.dataset.mark === mark) continue;
      label.share.textContent = percent;
      label.node.dataset.mark = mark;
      isOther = true;
    }
    if (isOther) this.#measure();
    else this.#place();
  }

  /** Measures all labels again. */
  #measure() {
    for (const label of this.#labels) {
      label.width = label.node.offsetWidth;
      label.height = label.node.offsetHeight;
    }
    this.#place();
  }

  #place() {
    const seen = this.#labels.map((label, n) => ({ label, at: this.#places[n] ?? null }));
    const isWanted = ({ label, at }) =>
      at !== null && (this.#frame.width >= NARROW || label.node.dataset.mark);
    const shown = seen.filter(isWanted);
    const wishes = shown.map(({ label: { width, height, weight }, at }) => ({
      ...at,
      width,
      height,
      weight,
    }));
    const places = placeLabels(/** @type {Wish[]} */ (wishes), this.#frame);
    for (const entry of seen) if (!isWanted(entry)) entry.label.node.dataset.hidden = "true";
    for (const [n, { label }] of shown.entries()) {
      const at = places[n];
      label.node.dataset.hidden = String(at === null);
      if (at)
        label.node.style.setProperty(
          "transform",
          `translate(${at.x.toFixed(1)}px, ${at.y.toFixed(1)}px)`,
        );
    }
  }
}
