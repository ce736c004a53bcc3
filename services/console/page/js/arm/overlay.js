// @ts-check
import { eachFrame, h, s, setAttribute } from "../dom.js";
import { shareWords } from "../model/ranking.js";
import { placeLabels } from "./placement.js";
import { objectAt } from "./pointing.js";

/** Labels that would fill more than this share of the picture are made smaller. */
const DENSE = 0.22;

/** Names of the objects over the picture, and the lines that lead to them. */
export class Overlay {
  /** @type {{node: HTMLElement, share: HTMLElement, leader: SVGElement, width: number, height: number, weight: number}[]} */
  #labels = [];
  /** @type {{belief: number|null, best: boolean, asked: boolean}[]} */
  #thoughts = [];
  /** Which object is in the gripper, and which is pointed at; -1 for none. */
  #held = -1;
  #hovered = -1;
  /** @type {import("./placement.js").Rect[]} */
  #boxes = [];
  /** @type {(import("./placement.js").Place|null)[]} */
  #places = [];
  #frame = { width: 0, height: 0 };
  #scene = null;
  /** @type {((n: number) => void)|null} */
  #choose = null;
  #placeSoon = eachFrame(() => this.#place());

  /**
   * @param {{labels: HTMLElement, leaders: SVGElement, notices: HTMLElement[]}} parts
   * @param {{percent: (share: number) => string}} t
   */
  constructor({ labels, leaders, notices }, t) {
    this.t = t;
    this.list = labels;
    this.leaders = leaders;
    this.notices = notices;
  }

  /** @param {any} scene section `scene` */
  setScene(scene) {
    this.#scene = scene;
    this.#boxes = [];
    this.#build();
  }

  /**
   * Makes the names buttons, or plain text again.
   * @param {((n: number) => void)|null} choose called with the object's place in the scene
   */
  setChooser(choose) {
    const isOther = (choose === null) !== (this.#choose === null);
    this.#choose = choose;
    if (isOther && this.#scene) this.#build();
  }

  #build() {
    const make = (object, n) => {
      const share = h("span", { class: "arm-share" });
      const name = h("span", { class: "arm-words", text: apart(object, this.#scene.noun) });
      const onclick = () => this.#choose?.(n);
      const words = this.#choose
        ? h("button", { type: "button", class: "arm-name", onclick }, name, share)
        : h("span", { class: "arm-name" }, name, share);
      const leader = s("line", {});
      return { node: h("li", { class: "arm-label" }, words), share, leader };
    };
    const none = { width: 0, height: 0, weight: 0 };
    this.#labels = this.#scene.objects.map((object, n) => ({ ...make(object, n), ...none }));
    this.#places = [];
    this.list.replaceChildren(...this.#labels.map(({ node }) => node));
    this.leaders.replaceChildren(...this.#labels.map(({ leader }) => leader));
    this.#mark();
    this.#measure();
  }

  /** @param {{belief: number|null, best: boolean, asked: boolean}[]} thoughts */
  setThoughts(thoughts) {
    this.#thoughts = thoughts;
    this.#mark();
  }

  /** @param {{width: number, height: number}} frame of the picture */
  setSize(frame) {
    this.#frame = frame;
    this.#places = [];
    this.#measure();
  }

  /**
   * Puts the labels next to their objects.
   * @param {import("./placement.js").Rect[]} boxes of the objects in the picture
   * @param {number} held which object is in the gripper, -1 for none
   */
  place(boxes, held) {
    this.#boxes = boxes;
    if (held === this.#held) return this.#placeSoon();
    this.#held = held;
    this.#mark();
  }

  /** The object at a point of the picture, -1 for none. @param {{x: number, y: number}} point */
  at(point) {
    const targets = this.#boxes.map((box, n) => ({ box, label: this.#rectOf(n) }));
    return objectAt(targets, point);
  }

  /** Emphasises the name of an object. @param {number} n -1 for none */
  hover(n) {
    if (n === this.#hovered) return;
    this.#hovered = n;
    for (const [k, { node }] of this.#labels.entries()) {
      setAttribute(node, "data-hover", k === n);
    }
  }

  #mark() {
    let isOther = false;
    for (const [n, label] of this.#labels.entries()) {
      const { belief = null, best = false, asked = false } = this.#thoughts[n] ?? {};
      const isHeld = n === this.#held;
      const percent = belief === null ? "" : ` ${shareWords(belief, this.t)}`;
      const mark = isHeld ? "held" : asked ? "asked" : best ? "best" : "";
      label.weight = (isHeld ? 4 : 0) + (asked ? 2 : 0) + (best ? 1 : 0) + (belief ?? 0);
      label.node.dataset.faint = String(belief !== null && belief < 0.02 && !isHeld);
      if (label.share.textContent === percent && label.node.dataset.mark === mark) continue;
      label.share.textContent = percent;
      label.node.dataset.mark = mark;
      isOther = true;
    }
    if (isOther) this.#measure();
    else this.#placeSoon();
  }

  /** Measures all labels again; small ones if the picture has no room for large ones. */
  #measure() {
    setAttribute(this.list, "data-dense", false);
    this.#read();
    const area = this.#labels.reduce((sum, { width, height }) => sum + width * height, 0);
    if (area > DENSE * this.#frame.width * this.#frame.height) {
      setAttribute(this.list, "data-dense", true);
      this.#read();
    }
    this.#placeSoon();
  }

  #read() {
    for (const label of this.#labels) {
      label.width = label.node.offsetWidth;
      label.height = label.node.offsetHeight;
    }
  }

  #rectOf(n) {
    const place = this.#places[n];
    const { width, height } = this.#labels[n] ?? { width: 0, height: 0 };
    return place ? { x: place.x, y: place.y, width, height } : null;
  }

  #place() {
    if (this.#boxes.length !== this.#labels.length || !this.#frame.width) return;
    const wishes = this.#labels.map(({ width, height, weight }, n) => ({
      box: this.#boxes[n],
      width,
      height,
      weight,
    }));
    const notices = this.notices.filter(({ hidden }) => !hidden).map(rectOf);
    this.#places = placeLabels(wishes, this.#frame, notices, this.#places);
    for (const [n, { node, leader }] of this.#labels.entries()) {
      const { x, y, leader: line } = /** @type {any} */ (this.#places[n]);
      node.style.setProperty("transform", `translate(${Math.round(x)}px, ${Math.round(y)}px)`);
      const ends = line ?? [0, 0, 0, 0];
      for (const [k, name] of ["x1", "y1", "x2", "y2"].entries()) {
        setAttribute(leader, name, ends[k].toFixed(1));
      }
      setAttribute(leader, "data-mark", node.dataset.mark ?? "");
      // With a line it is as visible as all of them.
      setAttribute(leader, "visibility", line ? null : "hidden");
    }
    setAttribute(this.list, "data-placed", true);
  }
}

/**
 * Distinctive part of an object's label: without the noun that all of them share.
 * @param {{label?: string, name: string}} object
 * @param {string} noun
 */
export function apart({ label, name }, noun) {
  const whole = label ?? name;
  const words = whole.split(" ").filter((word) => word !== noun);
  return words.length > 0 ? words.join(" ") : whole;
}

/** @param {HTMLElement} node @returns {import("./placement.js").Rect} */
function rectOf({ offsetLeft, offsetTop, offsetWidth, offsetHeight }) {
  return { x: offsetLeft, y: offsetTop, width: offsetWidth, height: offsetHeight };
}
