// @ts-check
/**
 * An element of the robot's description as it travels from the page.
 * @typedef {{name: string, attributes: Record<string, string>, children: Tree[]}} Tree
 */

const CHILD_OF_JOINT = /^child\[link="(.*)"\]$/s;

/** The part of an element that urdf-loader needs; there is no DOM in the drawing worker. */
export class TreeElement {
  #attributes;
  nodeName;
  /** @type {TreeElement[]} */
  children;

  /** @param {Tree} tree */
  constructor({ name, attributes, children }) {
    this.nodeName = name;
    this.#attributes = attributes;
    this.children = children.map((child) => new TreeElement(child));
  }

  /** @param {string} name */
  getAttribute(name) {
    return this.#attributes[name] ?? null;
  }

  /** Knows the one question that the loader has: which joint leads to a link. @param {string} selector */
  querySelector(selector) {
    const link = selector.match(CHILD_OF_JOINT)?.[1];
    if (link === undefined) throw new Error(`what is ${selector}?`);
    return this.#find((node) => node.nodeName === "child" && node.getAttribute("link") === link);
  }

  /** @param {(node: TreeElement) => boolean} isWanted @returns {TreeElement|null} */
  #find(isWanted) {
    for (const child of this.children) {
      const found = isWanted(child) ? child : child.#find(isWanted);
      if (found) return found;
    }
    return null;
  }
}

// The loader looks whether it was given a document or an element: workers have neither.
globalThis.Document ??= /** @type {any} */ (class Document {});
globalThis.Element ??= /** @type {any} */ (class Element {});
// A field of the class's own, such as `nodeName`, covers what a real element has in its place.
Object.setPrototypeOf(TreeElement.prototype, globalThis.Element.prototype);
