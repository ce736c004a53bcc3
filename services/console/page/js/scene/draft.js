// @ts-check
/** Steps that can be undone. */
const STEPS_MAX = 200;

/**
 * A scene while it is edited: the document, and the steps that led to it.
 */
export class Draft {
  /** @type {any[]} documents before the present one, oldest first */
  #before = [];
  /** @type {any[]} documents that were undone, latest first */
  #after = [];
  /** Subject of the last step: a step of the same continues it. */
  #last = "";

  /**
   * @param {object} opened as the server has it
   * @param {string|null} opened.name null for a new scene
   * @param {string} opened.text of the file
   * @param {string|null} opened.hash of the file; null for a new one
   * @param {any} opened.document
   */
  constructor({ name, text, hash, document }) {
    Object.assign(this, { name, text, hash });
    this.saved = JSON.stringify(document);
    this.document = document;
  }

  /** Returns whether something is not saved. */
  get isChanged() {
    return this.hash === null || JSON.stringify(this.document) !== this.saved;
  }

  get canUndo() {
    return this.#before.length > 0;
  }

  get canRedo() {
    return this.#after.length > 0;
  }

  /**
   * Changes a copy of the document.
   * @template T
   * @param {(document: any) => T} f
   * @param {string} [what] steps with the same one are undone together: "move 3"
   * @returns {T}
   */
  change(f, what = "") {
    const next = structuredClone(this.document);
    const result = f(next);
    if (JSON.stringify(next) === JSON.stringify(this.document)) return result;
    if (what === "" || what !== this.#last) {
      this.#before = [...this.#before.slice(1 - STEPS_MAX), this.document];
    }
    this.#after = [];
    this.#last = what;
    this.document = next;
    return result;
  }

  /** The next step is one of its own. */
  settle() {
    this.#last = "";
  }

  undo() {
    this.#step(this.#before, this.#after);
  }

  redo() {
    this.#step(this.#after, this.#before);
  }

  #step(from, to) {
    const next = from.pop();
    if (next === undefined) return;
    to.push(this.document);
    this.document = next;
    this.#last = "";
  }

  /**
   * Adopts the server's text. The steps before belong to another text, whose entries have other
   * numbers: they are gone.
   * @param {{name: string, text: string, hash: string, document: any}} saved
   */
  setSaved({ name, text, hash, document }) {
    Object.assign(this, { name, text, hash, document });
    this.saved = JSON.stringify(document);
    [this.#before, this.#after, this.#last] = [[], [], ""];
  }
}
