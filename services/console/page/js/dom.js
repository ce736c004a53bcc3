// @ts-check
const SVG = "http://www.w3.org/2000/svg";

/**
 * Makes an element. Properties are attributes, but for `class`, `text`, and listeners `onclick` ….
 * @template {keyof HTMLElementTagNameMap} K
 * @param {K} tag
 * @param {Record<string, any>} [properties] null and false leave an attribute out
 * @param {...(Node|string|null)} children
 * @returns {HTMLElementTagNameMap[K]}
 */
export function h(tag, properties = {}, ...children) {
  return fill(document.createElement(tag), properties, children);
}

/**
 * Makes an SVG element.
 * @param {string} tag
 * @param {Record<string, any>} [attributes]
 * @param {...(Node|string|null)} children
 * @returns {SVGElement}
 */
export function s(tag, attributes = {}, ...children) {
  return fill(document.createElementNS(SVG, tag), attributes, children);
}

function fill(node, properties, children) {
  for (const [name, value] of Object.entries(properties)) {
    if (value === null || value === undefined || value === false) continue;
    if (name === "text") node.textContent = value;
    else if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else node.setAttribute(name, value === true ? "" : String(value));
  }
  node.append(...children.filter((child) => child !== null));
  return node;
}

/** Sets a text only if it differs. @param {Node} node @param {string} text */
export function setText(node, text) {
  if (node.textContent !== text) node.textContent = text;
}

/**
 * Sets an attribute only if it differs; null removes it.
 * @param {Element} node
 * @param {string} name
 * @param {string|number|boolean|null} value
 */
export function setAttribute(node, name, value) {
  if (value === null || value === false) {
    if (node.hasAttribute(name)) node.removeAttribute(name);
    return;
  }
  const text = value === true ? "" : String(value);
  if (node.getAttribute(name) !== text) node.setAttribute(name, text);
}

/**
 * Makes the children of `parent` those of `items`, in their order: nodes are kept by key, made by
 * `make`, and moved only if they are elsewhere.
 * @template T
 * @param {Element} parent
 * @param {T[]} items
 * @param {(item: T) => string|number} key
 * @param {(item: T) => Element} make
 * @param {(node: any, item: T) => void} [update]
 */
export function keyed(parent, items, key, make, update = () => {}) {
  const known = /** @type {any} */ (parent).nodesByKey ?? new Map();
  const next = new Map();
  for (const item of items) {
    const id = key(item);
    const node = known.get(id) ?? make(item);
    known.delete(id);
    next.set(id, node);
    update(node, item);
  }
  for (const node of known.values()) node.remove();
  let place = parent.firstElementChild;
  for (const node of next.values()) {
    if (node === place) place = place.nextElementSibling;
    else parent.insertBefore(node, place);
  }
  /** @type {any} */ (parent).nodesByKey = next;
}

/**
 * Puts calls together: `draw` runs at most once a frame.
 * @param {() => void} draw
 * @returns {() => void}
 */
export function eachFrame(draw) {
  let waits = false;
  return () => {
    if (waits) return;
    waits = true;
    requestAnimationFrame(() => {
      waits = false;
      draw();
    });
  };
}

/**
 * The local time of day.
 * @param {{unix_ms: number}} event
 * @param {string} language
 */
export function clockOf({ unix_ms }, language) {
  const form = { hour: "2-digit", minute: "2-digit", second: "2-digit", hourCycle: "h23" };
  return new Date(unix_ms).toLocaleTimeString(language, /** @type {any} */ (form));
}

/** Returns whether the person asked for reduced motion, in the settings of the page or of the system. */
export function calm() {
  const isLess = document.documentElement.dataset.motion === "less";
  return isLess || matchMedia("(prefers-reduced-motion: reduce)").matches;
}
