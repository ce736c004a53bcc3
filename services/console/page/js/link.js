// @ts-check
import { backoffMs } from "./link/backoff.js";
import { Clock } from "./link/clock.js";
import { LinkError, Requests } from "./link/requests.js";
import { addressOf } from "./place.js";

export { LinkError };

/** Version of the protocol that this page speaks. */
const PROTOCOL = 2;
/** Between two pings, milliseconds. */
const PING_MS = 2_000;
/**
 * A server that is silent for more pings than that is gone. Pings and not seconds: a page that was
 * busy or asleep has not looked, and finds the new messages when it does.
 */
const SILENT_PINGS = 3;
/** Deadline for an answer from a connection after the page was hidden, milliseconds. */
const PROBE_MS = 1_200;
/** Timeout of a request, milliseconds. */
const DEADLINE_MS = 10_000;
/** The server closes with it when another page uses the same session. */
const REPLACED = 4001;
/** … and when too many pages are open, and this one was idle for the longest time. */
const GAVE_WAY = 4002;
/** After so many attempts the page asks whether the server wants its token first. */
const ATTEMPTS = 2;

/**
 * @typedef {object} Status
 * @property {"connecting"|"up"|"down"|"replaced"|"gave_way"} state in the last two it waits for its user
 * @property {number} since page time of the last change
 * @property {number} attempt failed attempts in a row
 * @property {number|null} retryAt page time of the next attempt
 * @property {number|null} tripMs the least round trip of late
 */

/**
 * A link to the server that mends itself: it connects again, reports what it has seen already, and
 * keeps the server's clock.
 * @param {object} options
 * @param {string} [options.url] the socket's address; by default `/ws` of the page's server
 * @param {string} options.session 32 hexadecimal digits, see `sessionId`
 * @param {"operator"|"viewer"|"screen"} [options.role] role that this page requests
 * @param {() => string} [options.name] its name for other viewers
 * @param {() => number} [options.lastLine] the newest transcript line that the page has
 * @param {(parts: object) => void} [options.onState] the same as `on("state", …)`
 * @param {() => void} [options.refused] when it cannot connect: by default looks for the login page
 * @param {typeof WebSocket} [options.socket] for tests
 * @param {() => number} [options.now] page time, for tests
 * @returns {Link}
 */
export function connect(options) {
  return new Link(options);
}

class Link {
  #options;
  #now;
  #clock = new Clock();
  #requests = new Requests();
  /** @type {Map<string, Set<(message: any) => void>>} */
  #listeners = new Map();
  /** @type {WebSocket|null} */
  #socket = null;
  #silent = 0;
  #helloAt = 0;
  #retry = 0;
  #probe = 0;
  #beat;
  /** @type {Status} */
  #status;

  constructor(options) {
    this.#options = {
      role: "operator",
      name: () => "",
      lastLine: () => 0,
      refused: askForToken,
      ...options,
    };
    this.#now = options.now ?? (() => performance.now());
    this.#status = {
      state: "connecting",
      since: this.#now(),
      attempt: 0,
      retryAt: null,
      tripMs: null,
    };
    if (options.onState) this.on("state", options.onState);
    this.#beat = setInterval(() => this.#tick(), PING_MS);
    if (typeof document !== "undefined") this.#watchPage();
    this.#open();
  }

  /** The server's `welcome`, null before the first one. @type {any} */
  welcome = null;

  /** @returns {Status} */
  get status() {
    return this.#status;
  }

  /** Returns whether a message sent now reaches the server. */
  get isUp() {
    return this.#status.state === "up";
  }

  /**
   * Hears of `state` (parts), `lines`, `joints`, `partial`, `receipt`, `welcome`, `status`, `error`.
   * @param {string} what
   * @param {(message: any) => void} f
   * @returns {() => void} stops it
   */
  on(what, f) {
    if (!this.#listeners.has(what)) this.#listeners.set(what, new Set());
    this.#listeners.get(what)?.add(f);
    return () => this.#listeners.get(what)?.delete(f);
  }

  /**
   * Asks the server to do something.
   * @param {string} verb
   * @param {object} [args]
   * @param {number} [deadlineMs] how long the answer is waited for
   * @returns {Promise<any>} the server's `done`; fails with a `LinkError`
   */
  do(verb, args = {}, deadlineMs = DEADLINE_MS) {
    if (!this.isUp) return Promise.reject(new LinkError("down", "There is no connection."));
    const { id, answer } = this.#requests.open(deadlineMs);
    this.#send({ ...args, t: "do", id, do: verb });
    return answer;
  }

  /**
   * Waits until the connection is up: a broken one is restored automatically.
   * @param {number} patienceMs
   * @returns {Promise<void>} fails with a `LinkError`
   */
  async up(patienceMs) {
    if (this.isUp) return;
    await new Promise((resolve, reject) => {
      const late = setTimeout(
        () => end(new LinkError("down", "There is no connection.")),
        patienceMs,
      );
      const stop = this.on("status", ({ state }) => state === "up" && end());
      /** @param {LinkError} [error] */
      const end = (error) => {
        clearTimeout(late);
        stop();
        if (error) reject(error);
        else resolve(undefined);
      };
    });
  }

  /**
   * Sends a binary frame.
   * @param {ArrayBuffer|ArrayBufferView<ArrayBuffer>} buffer
   * @returns {boolean} whether it was given to the connection
   */
  sendBinary(buffer) {
    if (!this.isUp || !this.#socket) return false;
    this.#socket.send(buffer);
    return true;
  }

  /** Bytes that wait to be sent: a slow connection. */
  get backlog() {
    return this.#socket?.bufferedAmount ?? 0;
  }

  /** The server's time now, milliseconds. */
  serverNow() {
    return this.toServer(this.#now());
  }

  /** @param {number} pageMs of `performance.now()` */
  toServer(pageMs) {
    return pageMs + this.#clock.offset;
  }

  /** @param {number} serverMs */
  toPage(serverMs) {
    return serverMs - this.#clock.offset;
  }

  /** Connects again at once, e.g. because an answer that matters did not come. */
  reconnect() {
    this.#drop();
    this.#update({ state: "connecting", retryAt: null });
    this.#open();
  }

  /** Ends it for good. */
  close() {
    clearInterval(this.#beat);
    this.#drop();
    clearTimeout(this.#retry);
  }

  #open() {
    clearTimeout(this.#retry);
    const Socket = this.#options.socket ?? WebSocket;
    const socket = new Socket(this.#options.url ?? ownUrl());
    socket.binaryType = "arraybuffer";
    this.#socket = socket;
    this.#silent = 0;
    socket.onopen = () => this.#hello();
    socket.onmessage = (event) => this.#hear(socket, event.data);
    socket.onclose = (event) => this.#lost(socket, event.code);
    this.#update({ retryAt: null });
  }

  #hello() {
    const { session, role, name, lastLine } = this.#options;
    this.#helloAt = this.#now();
    this.#send({
      t: "hello",
      protocol: PROTOCOL,
      session,
      name: name(),
      role,
      last_line: lastLine(),
    });
  }

  #hear(socket, data) {
    if (socket !== this.#socket || typeof data !== "string") return;
    this.#silent = 0;
    let message;
    try {
      message = JSON.parse(data);
    } catch {
      return;
    }
    switch (message.t) {
      case "welcome":
        return this.#welcomed(message);
      case "pong":
        return this.#ponged(message);
      case "done":
        return this.#requests.done(message);
      case "state":
        return this.#emit("state", message.parts ?? {});
      case "lines":
        return this.#emit("lines", message.lines ?? []);
      default:
        return this.#emit(message.t, message);
    }
  }

  #welcomed(message) {
    this.#clock.clear();
    this.#clock.add(this.#helloAt, this.#now(), message.server_ms);
    this.welcome = message;
    this.#emit("welcome", message);
    this.#update({ state: "up", attempt: 0, retryAt: null });
    this.#ping();
  }

  #ponged(message) {
    clearTimeout(this.#probe);
    this.#clock.add(message.at, this.#now(), message.server_ms);
    this.#update({ tripMs: this.#clock.tripMs });
  }

  #lost(socket, code) {
    if (socket !== this.#socket) return;
    this.#drop();
    if (code === REPLACED) return this.#update({ state: "replaced", retryAt: null });
    if (code === GAVE_WAY) return this.#update({ state: "gave_way", retryAt: null });
    const attempt = this.#status.attempt + 1;
    if (attempt === ATTEMPTS) this.#options.refused();
    const wait = backoffMs(attempt, Math.random());
    this.#retry = setTimeout(() => this.#open(), wait);
    this.#update({ state: "down", attempt, retryAt: this.#now() + wait });
  }

  #drop() {
    clearTimeout(this.#probe);
    const socket = this.#socket;
    this.#socket = null;
    if (socket) {
      socket.onopen = socket.onmessage = socket.onclose = null;
      socket.close();
    }
    this.#requests.lose();
  }

  #tick() {
    if (!this.#socket) return;
    this.#silent += 1;
    if (this.#silent > SILENT_PINGS) this.#lost(this.#socket, 0);
    else if (this.isUp) this.#ping();
  }

  #ping() {
    this.#send({ t: "ping", at: this.#now() });
  }

  /** A page that comes back into sight does not wait for its timers. */
  #watchPage() {
    const wake = () => {
      const waits = ["replaced", "gave_way"].includes(this.#status.state);
      if (document.visibilityState === "hidden" || waits) return;
      if (!this.isUp) return this.reconnect();
      this.#ping();
      clearTimeout(this.#probe);
      this.#probe = setTimeout(() => this.reconnect(), PROBE_MS);
    };
    document.addEventListener("visibilitychange", wake);
    addEventListener("online", wake);
    addEventListener("pageshow", (event) => event.persisted && wake());
  }

  #send(message) {
    if (this.#socket?.readyState === 1) this.#socket.send(JSON.stringify(message));
  }

  /** @param {Partial<Status>} change */
  #update(change) {
    const since =
      change.state && change.state !== this.#status.state ? this.#now() : this.#status.since;
    this.#status = { ...this.#status, ...change, since };
    this.#emit("status", this.#status);
  }

  #emit(what, message) {
    for (const f of this.#listeners.get(what) ?? []) f(message);
  }
}

function ownUrl() {
  return addressOf("/ws").replace(/^http/, "ws");
}

/** A server that requires its token rejects sockets without a reason; a page request shows it. */
async function askForToken() {
  try {
    const answer = await fetch(addressOf("/api/state"), { method: "HEAD", cache: "no-store" });
    if (answer.status === 401) location.assign(addressOf("/login"));
  } catch {
    // Unreachable: the page shows that already.
  }
}
