// @ts-check
import { addressOf } from "../place.js";

/** Interactions that are fetched at a time. */
const PAGE = 50;

/**
 * The list of interactions, fetched from the newest on as far as it is looked at.
 */
export class Source {
  /** @type {import("./model.js").Summary[]} newest first */
  list = [];
  total = 0;
  /** @type {import("./model.js").Summary|null} the oldest that there is */
  oldest = null;
  /** @type {Promise<void>|null} */
  #more = null;

  get isComplete() {
    return this.list.length >= this.total;
  }

  /** Fetches new interactions, and keeps the rest. */
  async refresh() {
    const { interactions, total, oldest } = await this.#page(null);
    const last = interactions.at(-1)?.interaction ?? Number.POSITIVE_INFINITY;
    const older = this.list.filter(({ interaction }) => interaction < last);
    // More than a page is new: those in between would be missing.
    const follows = older.length > 0 && this.list.some(({ interaction }) => interaction >= last);
    this.list = follows ? [...interactions, ...older] : interactions;
    [this.total, this.oldest] = [total, oldest];
  }

  /** Fetches older ones; does nothing without any. */
  more() {
    if (this.isComplete) return Promise.resolve();
    this.#more ??= this.#older().finally(() => {
      this.#more = null;
    });
    return this.#more;
  }

  async #older() {
    const last = this.list.at(-1)?.interaction ?? null;
    const { interactions, total, oldest } = await this.#page(last);
    // The list may have been replaced meanwhile.
    if ((this.list.at(-1)?.interaction ?? null) !== last) return;
    this.list = [...this.list, ...interactions];
    this.total = interactions.length === 0 ? this.list.length : total;
    this.oldest = oldest;
  }

  /** @param {number|null} before */
  async #page(before) {
    const query = new URLSearchParams({ limit: String(PAGE) });
    if (before !== null) query.set("before", String(before));
    return (await answer(`/api/history?${query}`)) ?? { interactions: [], total: 0, oldest: null };
  }
}

/**
 * Fetches an interaction.
 * @param {number} interaction
 * @returns {Promise<import("./model.js").Interaction|null>} null: there is none
 */
export const fetchOne = (interaction) => answer(`/api/history/${interaction}`);

async function answer(path) {
  const response = await fetch(addressOf(path));
  if (response.status === 404) return null;
  if (!response.ok) throw new Error(`${path}: ${response.status}`);
  return response.json();
}
