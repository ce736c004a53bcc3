// The page without a group: its files from this tree, and what a test says over its socket. For states that
// a group would take long to reach, or would leave too soon.

import { once } from "node:events";
import { readFile } from "node:fs/promises";
import { createServer } from "node:http";
import { extname, join } from "node:path";
import { ROOT } from "./program.mjs";

const PAGE = join(ROOT, "services/console/page");
const TYPES = {
  ".html": "text/html",
  ".js": "text/javascript",
  ".css": "text/css",
  ".json": "application/json",
  ".svg": "image/svg+xml",
};

/** The sections that the console sends, as its own test keeps them. */
export const GOLDEN = JSON.parse(
  await readFile(join(ROOT, "tests/golden/page_sections.json"), "utf8"),
);

/** The viewer that the page under test is. */
export const ME = "v1";

/** A console that says what a test has it say. */
export class Fed {
  #socket = null;
  #isUp = true;
  /** What `do` is answered with, by its verb; `ok` alone where nothing is said. */
  answers = {};
  settings = { language: "en", voice: { recogniser: false, voice: false }, simulated: true };

  /** Opens the page. @param {import("@playwright/test").Page} page @param {string} [path] */
  static async open(page, path = "/") {
    const fed = new Fed();
    const server = createServer(serve).listen(0, "127.0.0.1");
    await once(server, "listening");
    page.once("close", () => server.close());
    await page.routeWebSocket(/\/ws$/, (socket) => fed.#greet(socket));
    await page.goto(`http://127.0.0.1:${server.address().port}${path}`);
    return fed;
  }

  /** Says sections. @param {Record<string, any>} parts */
  state(parts) {
    this.#say({ t: "state", parts });
  }

  /** Says lines of the transcript. @param {object[]} lines */
  lines(lines) {
    const at = (line, n) => ({ at_ms: n, unix_ms: 1_700_000_000_000 + n, ...line });
    this.#say({ t: "lines", lines: lines.map(at) });
  }

  /** Breaks the connection, and refuses others. */
  async cut() {
    this.#isUp = false;
    await this.#socket?.close({ code: 1001 });
  }

  /** Lets the page connect again. */
  mend() {
    this.#isUp = true;
  }

  #say(message) {
    this.#socket?.send(JSON.stringify(message));
  }

  #greet(socket) {
    if (!this.#isUp) return socket.close({ code: 1001 });
    this.#socket = socket;
    socket.onMessage((text) => this.#hear(JSON.parse(String(text))));
  }

  #hear({ t, at, id, do: verb }) {
    const now = { server_ms: 10_000 };
    const { settings } = this;
    const about = { protocol: 2, viewer: ME, version: "0", group: "test", first_line: 1, settings };
    if (t === "hello") this.#say({ t: "welcome", ...about, ...now });
    if (t === "ping") this.#say({ t: "pong", at, ...now });
    if (t === "do") this.#say({ t: "done", id, ok: true, ...this.answers[verb] });
  }
}

/** Answers with a file of the page. */
async function serve({ url }, response) {
  const { pathname } = new URL(url, "http://page");
  const name = pathname === "/" ? "/index.html" : pathname;
  const path = extname(name) ? name : `${name}.html`;
  const body = await readFile(join(PAGE, path)).catch(() => null);
  response.writeHead(body ? 200 : 404, { "content-type": TYPES[extname(path)] ?? "text/plain" });
  response.end(body);
}
