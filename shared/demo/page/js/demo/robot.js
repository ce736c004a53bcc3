// The robot in this page: a WebAssembly module takes the place of the console's link to a server.
// Its sections are those of docs/console.md, so the console's views show them.

/** Longest wait between two looks at the robot, milliseconds: while nothing moves, and while the arm does. */
const IDLE_MS = 100;
const MOVING_MS = 30;

/**
 * Loads the module.
 * @param {URL} url
 * @returns {Promise<Robot>}
 */
export async function loadRobot(url) {
  const answer = await fetch(url);
  if (!answer.ok) throw new Error(`${answer.status} ${answer.statusText}`);
  // Not by streaming: static servers do not agree about the type of such files.
  const { instance } = await WebAssembly.instantiate(await answer.arrayBuffer(), {});
  return new Robot(instance.exports);
}

export class Robot {
  #exports;
  #listeners = new Map();
  /** Page time at which the dialogue began. */
  #began = 0;
  /** The robot's time at the latest answer, and page time then. */
  #known = { robotMs: 0, pageMs: 0 };
  #timer = 0;
  #frame = 0;
  #moves = false;
  #lastLine = 0;
  #dialogue = null;
  #scene = null;
  #arm = null;

  /** @param {any} exports of the module */
  constructor(exports) {
    this.#exports = exports;
  }

  /** There is always a connection. */
  status = { state: "up" };
  isUp = true;
  up = async () => {};

  /** Listens to `state` (sections), `lines`, `welcome`, `broken`. */
  on(what, f) {
    if (!this.#listeners.has(what)) this.#listeners.set(what, new Set());
    this.#listeners.get(what).add(f);
    return () => this.#listeners.get(what).delete(f);
  }

  /** Names of the scenes. @returns {string[]} */
  scenes() {
    return this.#call({ do: "scenes" }).scenes;
  }

  /** Begins a dialogue. @param {string} scene */
  open(scene) {
    this.#began = performance.now();
    this.#lastLine = 0;
    this.#emit("welcome", { viewer: "demo", first_line: 0, settings: {} });
    const own = {
      control: { operator: "demo", viewers: 1 },
      group: { services: [] },
      motion: { unconfirmed: null },
    };
    this.#emit("state", own);
    this.#carryOut({ do: "open", scene, unix_ms: Date.now() });
    this.#schedule();
  }

  /**
   * Carries out a verb of the console's protocol.
   * @param {string} verb
   * @param {Record<string, any>} [args]
   */
  async do(verb, args = {}) {
    const say = (text, seen = this.#dialogue.prompt) =>
      this.#carryOut({ do: "say", text, seen, ...this.#at() });
    if (verb === "say") return say(args.text, args.seen);
    if (verb === "not_that") return say(this.#notThat());
    if (verb === "start_over") {
      const fetches = ["pick", "cancel"].includes(this.#dialogue.decision);
      return say(fetches ? "never mind" : "start over");
    }
    return this.#carryOut({ do: verb, ...this.#at() });
  }

  /** Robot time of a page time. */
  toServer(pageMs) {
    return this.#known.robotMs + pageMs - this.#known.pageMs;
  }

  /** Robot time, milliseconds. */
  serverNow() {
    return this.toServer(performance.now());
  }

  /** Words that deny the object in question. */
  #notThat() {
    if (this.#dialogue.decision !== "pick") return "no";
    const object = this.#scene.objects.find(({ name }) => name === this.#arm?.object);
    return object ? `no, not the ${object.description}` : "no, not that one";
  }

  #at() {
    return { at_ms: performance.now() - this.#began };
  }

  #schedule() {
    clearTimeout(this.#timer);
    cancelAnimationFrame(this.#frame);
    const look = () => {
      this.#carryOut({ do: "look", ...this.#at() }, true);
      this.#schedule();
    };
    this.#timer = setTimeout(
      () => {
        this.#frame = requestAnimationFrame(look);
      },
      this.#moves ? MOVING_MS : IDLE_MS,
    );
  }

  /** Has a command carried out, and reports what has changed. */
  #carryOut(command, isQuiet = false) {
    let answer;
    try {
      answer = this.#call(command);
    } catch (error) {
      clearTimeout(this.#timer);
      this.#emit("broken", error);
      if (isQuiet) return {};
      throw Object.assign(error, { code: "refused" });
    }
    if (answer.now_ms !== undefined) {
      this.#known = { robotMs: answer.now_ms, pageMs: performance.now() };
    }
    const { lines, ...parts } = answer.sections ?? {};
    this.#dialogue = parts.dialogue ?? this.#dialogue;
    this.#scene = parts.scene ?? this.#scene;
    this.#arm = parts.arm ?? this.#arm;
    this.#moves = this.#arm?.moving ?? false;
    if (Object.keys(parts).length > 0) this.#emit("state", parts);
    const fresh = (lines ?? []).filter(({ id }) => id > this.#lastLine);
    if (fresh.length > 0) {
      this.#lastLine = fresh.at(-1).id;
      this.#emit("lines", fresh);
    }
    if (answer.error) throw Object.assign(new Error(answer.error), { code: "refused" });
    if (!isQuiet) this.#schedule();
    return answer;
  }

  /** Calls the module: a text in, a text out. */
  #call(command) {
    const { memory, whichone_input, whichone_command, whichone_output } = this.#exports;
    const bytes = new TextEncoder().encode(JSON.stringify(command));
    const place = whichone_input(bytes.length);
    if (place === 0) throw new Error(`a command of ${bytes.length} bytes`);
    new Uint8Array(memory.buffer, place, bytes.length).set(bytes);
    const length = whichone_command();
    // The memory may have grown meanwhile.
    const answer = new Uint8Array(memory.buffer, whichone_output(), length);
    return JSON.parse(new TextDecoder().decode(answer));
  }

  #emit(what, message) {
    for (const f of this.#listeners.get(what) ?? []) f(message);
  }
}
