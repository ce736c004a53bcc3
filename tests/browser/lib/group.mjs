// A process group for one test: its own name, home, shared memory and port.

import { cp, mkdtemp, readdir, readFile, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { ROOT, whichone } from "./program.mjs";
import { until } from "./until.mjs";

/** Waits until a release counts. The page's clock may stand still: this is the arm's. */
export const releaseCounts = () => new Promise((done) => setTimeout(done, 2_100));

/** A running group. */
export class Group {
  /** @param {string} home @param {string} name */
  constructor(home, name) {
    this.home = home;
    this.name = name;
    this.config = join(ROOT, "config");
    this.url = "";
    this.token = "";
  }

  /**
   * Starts a group with the profile for tests and waits until it is ready.
   * @param {string[]} settings `key=value` each
   * @param {string} [name] what the group is called; one of its own where nothing is said
   * @param {boolean} [ownConfig] a copy of the configuration, for a test that changes its files
   */
  static async up(settings = [], name = undefined, ownConfig = false) {
    const home = await mkdtemp(join(tmpdir(), "wb"));
    const own = `b${process.pid}-${home.slice(-6).toLowerCase()}`;
    const group = new Group(home, name ?? own);
    if (ownConfig) {
      const shipped = group.config;
      group.config = join(home, "config");
      await cp(shipped, group.config, { recursive: true });
    }
    try {
      await group.#start(settings);
    } catch (error) {
      await group.down();
      throw error;
    }
    return group;
  }

  /** Stops the group and starts it again with its journals. @param {string[]} [settings] */
  async again(settings = []) {
    await this.must("down");
    await this.#start(settings);
  }

  async #start(settings) {
    const up = ["up", "--detach", "--wait", "ready", "--timeout", "40", "--profile", "ci"];
    // A busy machine's browser may take its time to answer.
    const patient = ["dialogue.turns.response_window_s=20.0", ...settings];
    // To load the recogniser's model takes most of the processor time of a start.
    const isSpokenTo = settings.some((setting) => setting.startsWith("speech."));
    if (!isSpokenTo) patient.push("speech.recogniser=none");
    const sets = patient.flatMap((setting) => ["--set", setting]);
    await this.must(...up, "--config", this.config, ...sets);
    const { console: url, token } = await this.json("console");
    Object.assign(this, { url, token });
  }

  /** The link to a page of the console with which its owner gets in. @param {string} [path] */
  link(path = "/") {
    const link = new URL(path, this.url);
    link.searchParams.set("token", this.token);
    return link.href;
  }

  /** Runs `whichone WORDS…` for this group. @param {string[]} words */
  call(...words) {
    return whichone(words, { WHICHONE_HOME: this.home, WHICHONE_GROUP: this.name });
  }

  /** As `call`, for what must succeed; its output. @param {string[]} words */
  async must(...words) {
    const ended = await this.call(...words);
    if (ended.code === 0) return ended.stdout;
    const logs = await this.logs();
    throw new Error(`whichone ${words.join(" ")}: ${ended.code}\n${ended.stderr}\n${logs}`);
  }

  /** Releases the motion stop, once a release counts: 2 s after the latest stop, by the arm's clock. */
  async release() {
    await releaseCounts();
    await until("the release", async () => {
      const ended = await this.call("resume-motion");
      if (ended.code !== 0 && !ended.stderr.includes("less than 2 s before"))
        throw new Error(ended.stderr);
      return ended.code === 0;
    });
  }

  /** As `must`, read as JSON. @param {string[]} words */
  async json(...words) {
    return JSON.parse(await this.must(...words, "--json"));
  }

  /** Everything that the console shows, from its own interface. */
  async state() {
    const headers = { authorization: `Bearer ${this.token}` };
    const response = await fetch(new URL("/api/state", this.url), { headers });
    return response.json();
  }

  /** The text of a scene file of its configuration. @param {string} name */
  scene(name) {
    return readFile(join(this.config, "scenes", `${name}.toml`), "utf8");
  }

  /** What the supervisor says of one service. @param {string} name */
  async service(name) {
    const ended = await this.call("status", "--json");
    return JSON.parse(ended.stdout).services.find((service) => service.name === name);
  }

  /** Kills a service and waits until it is back. @param {string} name */
  async killAndWait(name) {
    const { pid, incarnation } = await this.service(name);
    process.kill(pid, "SIGKILL");
    await until(`${name} to come back`, async () => {
      const now = await this.service(name);
      return now.incarnation > incarnation && now.actual === "ready";
    });
  }

  /** The ends of the logs, for a test that failed. */
  async logs() {
    const files = await readdir(this.home, { recursive: true });
    const tail = async (file) => {
      const text = await readFile(join(this.home, file), "utf8");
      return `--- ${file}\n${text.split("\n").slice(-20).join("\n")}`;
    };
    const logs = await Promise.all(files.filter((file) => file.endsWith(".log")).map(tail));
    return logs.join("\n");
  }

  /** Stops the group and takes its home away. */
  async down() {
    await this.call("down");
    await rm(this.home, { recursive: true, force: true });
  }
}
