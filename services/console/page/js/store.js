// @ts-check
import { mergeLines } from "./model/lines.js";

/** Lines that are asked for once more after a lost connection. */
const OVERLAP = 10;

/**
 * State of the page. Sections are those of the server's `state`, and the page's own: `lines`
 * (transcript, oldest first), `partial`, `link` (status), `welcome`, `stale` (there is no connection, so the state is unknown), `cover` (the sheet that covers the page, or null).
 */
export class Store {
  /** @type {Map<string, any>} */
  #sections = new Map();
  /** @type {Map<string, Set<(value: any, section: string) => void>>} */
  #subscribers = new Map();

  /**
   * @param {string} section
   * @returns {any} undefined before it is known
   */
  get(section) {
    return this.#sections.get(section);
  }

  /**
   * Replaces a section whole.
   * @param {string} section
   * @param {any} value
   */
  set(section, value) {
    this.#sections.set(section, value);
    for (const f of this.#subscribers.get(section) ?? []) f(value, section);
  }

  /**
   * Takes in the parts of a `state` frame: all first, then the subscribers, so that none of them
   * sees half of it.
   * @param {Record<string, any>} parts
   */
  apply(parts) {
    const entries = Object.entries(parts);
    for (const [section, value] of entries) this.#sections.set(section, value);
    for (const [section, value] of entries) {
      for (const f of this.#subscribers.get(section) ?? []) f(value, section);
    }
  }

  /**
   * Takes in transcript lines.
   * @param {{id: number}[]} lines
   */
  addLines(lines) {
    this.set("lines", mergeLines(this.get("lines") ?? [], lines));
  }

  /**
   * A server that keeps fewer lines than the page has seen is another one: its transcript starts
   * again.
   * @param {number|undefined} firstLine number of the first line that the server keeps, 0 for none
   */
  resume(firstLine) {
    const lost = firstLine === 0 || (firstLine ?? 0) > this.lastLine + 1;
    if (lost && this.lastLine > 0) this.set("lines", []);
  }

  /** The line after which a server continues: the last few may have changed meanwhile. */
  get resumeAfter() {
    return Math.max(0, this.lastLine - OVERLAP);
  }

  /** The newest transcript line that is known, 0 for none. */
  get lastLine() {
    return this.get("lines")?.at(-1)?.id ?? 0;
  }

  /**
   * Calls `f` with the section's value, now if it is known and at each change.
   * @param {string|string[]} sections
   * @param {(value: any, section: string) => void} f
   * @returns {() => void} stops it
   */
  subscribe(sections, f) {
    const names = Array.isArray(sections) ? sections : [sections];
    for (const name of names) {
      if (!this.#subscribers.has(name)) this.#subscribers.set(name, new Set());
      this.#subscribers.get(name)?.add(f);
      if (this.#sections.has(name)) f(this.#sections.get(name), name);
    }
    return () => {
      for (const name of names) this.#subscribers.get(name)?.delete(f);
    };
  }
}

/**
 * Assembles the knowledge about the scene: the section `scene` has the objects with a place, as
 * `standing`; those of the section `further` follow them in `objects`.
 * @param {Store} store
 * @param {Record<string, any>} parts of a `state` frame
 */
function whole(store, parts) {
  if (!parts.scene && !parts.further) return parts;
  const scene = parts.scene ?? store.get("scene");
  if (!scene) return parts;
  const standing = parts.scene?.objects ?? scene.standing;
  const further = parts.further ?? store.get("further") ?? [];
  return { ...parts, scene: { ...scene, standing, objects: [...standing, ...further] } };
}

/**
 * Has a link's messages kept by a store.
 * @param {Store} store
 * @param {{on: (what: string, f: (message: any) => void) => void, status: object}} link
 */
export function keep(store, link) {
  link.on("state", (parts) => store.apply(whole(store, parts)));
  link.on("lines", (lines) => store.addLines(lines));
  link.on("partial", (partial) => store.set("partial", partial));
  link.on("welcome", (welcome) => {
    store.resume(welcome.first_line);
    store.set("welcome", welcome);
  });
  link.on("status", (status) => store.set("link", status));
  store.set("link", link.status);
}
