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
/** How far a label may be moved up to find room, in its own heights. */
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

  /** @param {HTMLElement} list @param {(key: string, args?: object) => string} t */
  constructor(list, t) {
    this.list = list;
    this.t = t;
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
    this.list.replaceChildren(...this.#labels.map(({ node }) => node));
    this.measure();
  }

  /**
   * @param {{belief: number|null, best: boolean, asked: boolean}[]} thoughts
   * @param {number} held which object is in the gripper, -1 for none
   */
  mark(thoughts, held) {
    let isOther = false;
    for (const [n, label] of this.#labels.entries()) {
      const { belief = null, best = false, asked = false } = thoughts[n] ?? {};
      const percent = belief === null ? "" : ` ${Math.round(100 * belief)} %`;
      const mark = n === held ? "held" : asked ? "asked" : best ? "best" : "";
      label.weight = (n === held ? 4 : 0) + (asked ? 2 : 0) + (best ? 1 : 0) + (belief ?? 0);
      label.node.dataset.faint = String(belief !== null && belief < 0.02 && n !== held);
      if (label.share.textContent === percent && label.node.dataset.mark === mark) continue;
      label.share.textContent = percent;
      label.node.dataset.mark = mark;
      isOther = true;
    }
    if (isOther) this.measure();
  }

  /** Takes the sizes of all labels anew. */
  measure() {
    for (const label of this.#labels) {
      label.width = label.node.offsetWidth;
      label.height = label.node.offsetHeight;
    }
  }

  /**
   * Puts the labels over what they name.
   * @param {(n: number) => {x: number, y: number}|null} placeOf in the picture; null: not seen
   * @param {{width: number, height: number}} frame
   */
  place(placeOf, frame) {
    const seen = this.#labels.map((label, n) => ({ label, at: placeOf(n) }));
    const isWanted = ({ label, at }) =>
      at !== null && (frame.width >= NARROW || label.node.dataset.mark);
    const shown = seen.filter(isWanted);
    const wishes = shown.map(({ label, at }) => ({
      ...at,
      width: label.width,
      height: label.height,
      weight: label.weight,
    }));
    const places = placeLabels(/** @type {Wish[]} */ (wishes), frame);
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
