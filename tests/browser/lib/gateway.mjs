// A gateway before the console of a test's group.

import { execFile, spawn } from "node:child_process";
import { once } from "node:events";
import { mkdtemp, readFile, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { promisify } from "node:util";
import { program } from "./program.mjs";

const run = promisify(execFile);

/** A running gateway. */
export class Gateway {
  /** @param {string} folder @param {import("node:child_process").ChildProcess} child @param {string} url */
  constructor(folder, child, url) {
    this.folder = folder;
    this.child = child;
    this.url = url;
  }

  /** Starts one. @param {import("./group.mjs").Group} group */
  static async up(group) {
    const folder = await mkdtemp(join(tmpdir(), "wg"));
    const words = ["serve", folder, "--group", group.name, "--listen", "127.0.0.1:0"];
    const env = { ...process.env, WHICHONE_HOME: group.home };
    const child = spawn(program("whichone-gateway"), words, {
      env,
      stdio: ["ignore", "pipe", "inherit"],
    });
    const [url] = await once(createInterface(child.stdout), "line");
    return new Gateway(folder, child, url);
  }

  /** Adds a person; the link with which the person gets in. @param {string[]} words name and rights */
  async add(...words) {
    const { stdout } = await run(program("whichone-gateway"), ["add", this.folder, ...words]);
    return stdout.trim().split(" ").at(-1) ?? "";
  }

  /** The audit's entries. */
  async audit() {
    const text = await readFile(join(this.folder, "audit.jsonl"), "utf8");
    return text
      .trim()
      .split("\n")
      .map((line) => JSON.parse(line));
  }

  async down() {
    this.child.kill();
    await once(this.child, "exit");
    await rm(this.folder, { recursive: true, force: true });
  }
}
