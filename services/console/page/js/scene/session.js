// @ts-check
import { Refused } from "./api.js";
import { addObject, freeSpot, rounded } from "./document.js";
import { Draft } from "./draft.js";
import { keepDraft, keptDraft } from "./kept_draft.js";
import { ReachMap, reachKey } from "./reach.js";

/** Time without a change after which the scene is checked, and the reach is asked for, milliseconds. */
const REST_MS = 350;
/** Longest wait for the group to come back with another scene, milliseconds, and interval of the looks. */
const SWITCH_MS = 60_000;
const LOOK_MS = 300;
/** Maps of the reach that are kept. */
const MAPS_MAX = 24;
const UNCHECKED = { state: "checking", problems: [], warnings: [], words: [], error: "" };

/**
 * State and actions of the editor: the draft, the chosen object, the checks and the reach. It asks the server
 * when nothing has changed for a moment, and gives up questions that are out of date.
 */
export class SceneSession {
  /** @type {Draft|null} */
  draft = null;
  /** The robot, as the server describes it. @type {any} */
  robot = null;
  /** @type {{names: string[], in_force: string, in_force_hash: string, locked: string|null}} */
  listed = { names: [], in_force: "", in_force_hash: "", locked: null };
  /** @type {number|null} */
  chosen = null;
  /** @type {{state: string, problems: any[], warnings: string[], words: string[], error: string}} */
  findings = { ...UNCHECKED, state: "idle" };
  /** Returns whether a request of the user is under way. */
  isBusy = false;
  /** The last failure, or the work in progress. */
  note = "";
  /** @type {Map<string, ReachMap>} */
  #maps = new Map();
  #reachAsked = new AbortController();
  #checkAsked = new AbortController();
  #timer = 0;

  /**
   * @param {ReturnType<typeof import("./api.js").scenesApi>} api
   * @param {object} around
   * @param {(key: string, args?: object) => string} around.t
   * @param {() => boolean} around.isOperator
   * @param {() => void} around.onChange
   * @param {(text: string) => void} around.notify
   */
  constructor(api, { t, isOperator, onChange, notify }) {
    Object.assign(this, { api, t, isOperator, onChange, notify });
  }

  get canEdit() {
    return this.draft !== null && !this.isBusy && this.isOperator();
  }

  get document() {
    return this.draft?.document ?? { noun: "", attributes: [], objects: [] };
  }

  /** The chosen object. */
  get object() {
    return this.document.objects[this.chosen ?? -1] ?? null;
  }

  /** Places where the chosen object can be fetched, as far as known. */
  get reach() {
    return this.#maps.get(reachKey(this.object)) ?? null;
  }

  /** Changes the document; does nothing for those who may not. @param {string} [what] see `Draft.change` */
  change(f, what = "") {
    if (!this.canEdit || !this.draft) return undefined;
    const result = this.draft.change(f, what);
    this.#changed();
    return result;
  }

  changeObject(n, f, what = "") {
    return this.change((document) => f(document.objects[n]), what);
  }

  /** @param {"undo"|"redo"} which */
  step(which) {
    if (!this.canEdit || !this.draft) return;
    this.draft[which]();
    this.#changed();
  }

  choose(n) {
    if (this.chosen === n) return;
    this.chosen = n;
    this.rest();
    this.onChange();
  }

  /** Adds an object like another one, or a plain one. @param {number|null} like */
  add(like) {
    const n = this.change((document) =>
      addObject(document, like, {
        spot: (size, z) => this.spot(size, z),
        table_z_m: this.robot.table_z_m,
      }),
    );
    if (n !== undefined) this.choose(n);
    return n;
  }

  remove() {
    const gone = this.chosen;
    if (gone === null) return;
    this.change((document) => document.objects.splice(gone, 1));
    const left = this.document.objects.length;
    this.chosen = left === 0 ? null : Math.min(gone, left - 1);
    this.onChange();
  }

  /** A free place for an object. @returns {[number, number]} */
  spot(size, z) {
    const map = this.reach;
    const reaches = (x, y) => (map?.at(x, y) ?? "") !== null;
    // In front of the robot, a little nearer than objects are handed over.
    const middle = /** @type {[number, number]} */ ([
      rounded(this.robot.hand_over_xyz_m[0] - 0.1),
      0,
    ]);
    return freeSpot(this.document.objects, size, z, { middle, reaches });
  }

  /** A free place on the table for an object that has no size yet. @returns {[number, number, number]} */
  placeOnTable() {
    const size = [0.1, 0.03, 0.05];
    const z = rounded(this.robot.table_z_m + size[2] / 2);
    return [...this.spot(size, z), z];
  }

  #changed() {
    if (this.chosen !== null && !this.object) this.chosen = null;
    this.findings = { ...this.findings, state: "checking" };
    this.rest();
    this.onChange();
  }

  /** Asks the server once nothing changes any more. */
  rest() {
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => {
      this.#check();
      this.#fillReach();
      keepDraft(this.draft?.isChanged ? this.draft : null);
    }, REST_MS);
  }

  async #check() {
    if (!this.canEdit || !this.draft || this.findings.state !== "checking") return;
    const { text, document } = this.draft;
    this.#checkAsked.abort();
    this.#checkAsked = new AbortController();
    const { signal } = this.#checkAsked;
    try {
      const found = await this.api.check({ text, document }, signal);
      if (document !== this.draft?.document) return;
      this.findings = { ...UNCHECKED, ...found, state: "done" };
    } catch (error) {
      if (signal.aborted) return;
      const problems = error.problems ?? [];
      const state = problems.length > 0 ? "done" : "failed";
      this.findings = { ...UNCHECKED, state, problems, error: error.message };
    }
    this.onChange();
  }

  async #fillReach() {
    const { object } = this;
    const key = reachKey(object);
    if (!key || !this.canEdit || this.#maps.get(key)?.isComplete) return;
    this.#reachAsked.abort();
    this.#reachAsked = new AbortController();
    const { signal } = this.#reachAsked;
    const map = this.#maps.get(key) ?? new ReachMap();
    this.#maps.delete(key);
    this.#maps.set(key, map);
    for (const old of [...this.#maps.keys()].slice(0, -MAPS_MAX)) this.#maps.delete(old);
    try {
      await map.fill(object, (one, at) => this.api.reach(one, at, signal), this.onChange);
    } catch {
      // Another object was chosen; or the server refuses this one, as the check says.
    }
  }

  /** Opens the scene that was edited before a reload of the page, else the one in force. */
  async begin() {
    await this.#attempt(async () => {
      this.listed = await this.api.list();
      if (this.draft) return;
      const { names, in_force } = this.listed;
      const kept = keptDraft();
      const first = names.includes(in_force) ? in_force : (names[0] ?? null);
      const which = kept ? kept.name : first;
      await this.#open(which).catch((error) => {
        // The file of the kept draft may be gone: any other shows the robot.
        if (!kept) throw error;
        return this.#open(first);
      });
      if (!kept || !this.draft) return;
      // A file that has changed since is refused when it is saved.
      Object.assign(this.draft, kept);
      this.notify(this.t("scene.restored"));
    });
  }

  /** Opens a scene. @param {string|null} name null: a new one */
  open(name) {
    return this.#attempt(() => this.#open(name));
  }

  async #open(name) {
    const opened = name === null ? await this.api.create() : await this.api.open(name);
    this.draft = new Draft(opened);
    this.robot = opened.robot;
    this.#maps.clear();
    this.chosen = opened.document.objects.length > 0 ? 0 : null;
    this.findings = { ...UNCHECKED };
  }

  /** Saves the draft. @param {string} name of the file; another one than the draft's makes a new file */
  save(name) {
    return this.#attempt(async () => {
      const { draft } = this;
      if (!draft) return;
      const isOwn = name === draft.name;
      const document = isOwn ? draft.document : { ...draft.document, name };
      const known = isOwn ? draft.hash : null;
      const isWrong = this.findings.problems.length > 0;
      const saved = await this.api.save(name, {
        text: draft.text,
        document,
        known,
        draft: isWrong,
      });
      draft.setSaved(saved);
      const { problems, warnings, words } = saved;
      this.findings = { state: "done", problems, warnings, words, error: "" };
      keepDraft(null);
      this.listed = await this.api.list();
      this.notify(this.t("scene.saved", { name }));
    });
  }

  /** Has the group use the saved scene. */
  use() {
    return this.#attempt(async () => {
      const { name, hash } = this.draft ?? {};
      if (!name) return;
      this.note = this.t("scene.switching", { name });
      this.onChange();
      try {
        await this.api.use(name);
      } catch (error) {
        // The console is restarted with the others: its answer may be lost.
        if (error instanceof Refused && error.status !== 503) throw error;
      }
      await this.#untilInForce(hash);
      this.notify(this.t("scene.used", { name }));
    });
  }

  async #untilInForce(hash) {
    const end = Date.now() + SWITCH_MS;
    while (Date.now() < end) {
      try {
        this.listed = await this.api.list();
        if (this.listed.in_force_hash === hash) return;
      } catch {
        // It is restarting.
      }
      await new Promise((resolve) => setTimeout(resolve, LOOK_MS));
    }
    throw new Error(this.t("scene.not_switched"));
  }

  /** Does something with the server; reports failures. */
  async #attempt(work) {
    this.isBusy = true;
    this.note = "";
    this.onChange();
    try {
      await work();
      this.note = "";
    } catch (error) {
      this.note = error instanceof TypeError ? this.t("scene.unavailable") : error.message;
      const problems = error.problems ?? [];
      if (problems.length > 0) this.findings = { ...UNCHECKED, state: "done", problems };
    }
    this.isBusy = false;
    this.rest();
    this.onChange();
  }
}
