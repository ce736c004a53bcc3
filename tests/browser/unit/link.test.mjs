import assert from "node:assert/strict";
import { afterEach, describe, it, mock } from "node:test";
import { backoffMs } from "../../../services/console/page/js/link/backoff.js";
import { Clock } from "../../../services/console/page/js/link/clock.js";
import { connect } from "../../../services/console/page/js/link.js";

const SESSION = "0123456789abcdef0123456789abcdef";

/** A socket whose other side is the test. */
class Socket {
  static made = [];
  readyState = 0;
  sent = [];
  constructor(url) {
    this.url = url;
    Socket.made.push(this);
  }
  send(data) {
    this.sent.push(typeof data === "string" ? JSON.parse(data) : data);
  }
  close() {
    this.readyState = 3;
  }
  accept() {
    this.readyState = 1;
    this.onopen();
  }
  say(message) {
    this.onmessage({ data: JSON.stringify(message) });
  }
  die(code = 1006) {
    this.readyState = 3;
    this.onclose?.({ code });
  }
  get last() {
    return this.sent.at(-1);
  }
}

const links = [];

function open(options = {}) {
  Socket.made = [];
  const link = connect({
    url: "ws://robot/ws",
    session: SESSION,
    socket: Socket,
    now: () => Date.now(),
    refused: () => {},
    ...options,
  });
  links.push(link);
  return link;
}

function welcome(socket, more = {}) {
  socket.accept();
  socket.say({ t: "welcome", protocol: 2, viewer: "v1", server_ms: 5_000, ...more });
}

afterEach(() => {
  for (const link of links.splice(0)) link.close();
  mock.timers.reset();
});

describe("the link", () => {
  it("says hello with what it has, and is up when it is welcomed", () => {
    const link = open({ role: "viewer", lastLine: () => 7 });
    const [socket] = Socket.made;
    const states = [];
    link.on("status", ({ state }) => states.push(state));
    socket.accept();
    assert.deepEqual(socket.sent[0], {
      t: "hello",
      protocol: 2,
      session: SESSION,
      name: "",
      role: "viewer",
      last_line: 7,
    });
    assert.equal(link.isUp, false);
    socket.say({ t: "welcome", viewer: "v1", server_ms: 5_000 });
    assert.equal(link.isUp, true);
    assert.equal(states.at(-1), "up");
    assert.equal(socket.last.t, "ping");
  });

  it("gives each answer to who asked, whatever their order", async () => {
    const link = open();
    const [socket] = Socket.made;
    welcome(socket);
    const first = link.do("say", { text: "the white one" });
    const { id } = socket.last;
    assert.deepEqual(socket.last, { t: "do", do: "say", id, text: "the white one" });
    const second = link.do("not_that");
    socket.say({ t: "done", id: socket.last.id, ok: false, error: "nothing is asked for" });
    socket.say({ t: "done", id, ok: true, seq: 3 });
    socket.say({ t: "done", id, ok: false, error: "twice" });
    assert.equal((await first).seq, 3);
    await assert.rejects(second, { code: "refused", message: "nothing is asked for" });
  });

  it("does not let arguments change what is asked", () => {
    const link = open();
    welcome(Socket.made[0]);
    link.do("say", { t: "hello", id: 99, do: "stop" }).catch(() => {});
    assert.equal(Socket.made[0].last.do, "say");
    assert.equal(Socket.made[0].last.t, "do");
  });

  it("fails at once without a connection, at its deadline without an answer", async () => {
    mock.timers.enable({ apis: ["setTimeout", "setInterval", "Date"] });
    const link = open();
    await assert.rejects(link.do("stop"), { code: "down" });
    welcome(Socket.made[0]);
    const late = link.do("say", { text: "x" }, 1_000);
    mock.timers.tick(1_000);
    await assert.rejects(late, { code: "late" });
  });

  it("loses what was open when the connection breaks, and connects again with its lines", async () => {
    mock.timers.enable({ apis: ["setTimeout", "setInterval", "Date"] });
    let lastLine = 2;
    const link = open({ lastLine: () => lastLine });
    welcome(Socket.made[0]);
    const lost = link.do("say", { text: "x" });
    lastLine = 9;
    Socket.made[0].die();
    await assert.rejects(lost, { code: "lost" });
    assert.equal(link.status.state, "down");
    assert.ok(link.status.retryAt > Date.now());
    mock.timers.tick(250);
    assert.equal(Socket.made.length, 2);
    welcome(Socket.made[1]);
    assert.equal(Socket.made[1].sent[0].last_line, 9);
    assert.equal(link.status.attempt, 0);
  });

  it("tries again less and less often, and looks for a login after the second failure", () => {
    mock.timers.enable({ apis: ["setTimeout", "setInterval", "Date"] });
    let refused = 0;
    open({ refused: () => refused++ });
    for (let attempt = 1; attempt <= 8; attempt++) {
      Socket.made.at(-1).die();
      mock.timers.tick(5_000);
    }
    assert.equal(Socket.made.length, 9);
    assert.equal(refused, 1);
  });

  it("waits for a connection that comes back, and not for ever for one that does not", async () => {
    mock.timers.enable({ apis: ["setTimeout", "setInterval", "Date"] });
    const link = open();
    const up = link.up(1_000);
    const late = link.up(100);
    mock.timers.tick(100);
    await assert.rejects(late, { code: "down" });
    welcome(Socket.made[0]);
    await up;
    await link.up(0);
  });

  it("does not take its own sleep for the server's silence", () => {
    let now = 0;
    const beats = mock.method(globalThis, "setInterval", () => 0);
    const link = open({ now: () => now });
    const [beat] = beats.mock.calls[0].arguments;
    beats.mock.restore();
    welcome(Socket.made[0]);
    for (let asleep = 0; asleep < 5; asleep++) {
      now += 20_000;
      beat();
      Socket.made[0].say({ t: "pong", at: now, server_ms: now });
    }
    assert.equal(link.isUp, true);
    assert.equal(Socket.made.length, 1);
  });

  it("notices a server that says nothing for six seconds", () => {
    mock.timers.enable({ apis: ["setTimeout", "setInterval", "Date"] });
    const link = open();
    welcome(Socket.made[0]);
    mock.timers.tick(6_000);
    assert.equal(link.isUp, true);
    mock.timers.tick(2_000);
    assert.equal(link.isUp, false);
    mock.timers.tick(300);
    assert.equal(Socket.made.length, 2);
  });

  it("ignores messages of an old connection and invalid messages", () => {
    const link = open();
    const [old] = Socket.made;
    welcome(old);
    const heard = old.onmessage;
    link.reconnect();
    const lines = [];
    link.on("lines", (more) => lines.push(...more));
    heard({ data: JSON.stringify({ t: "lines", lines: [{ id: 1 }] }) });
    Socket.made[1].accept();
    Socket.made[1].onmessage({ data: "no JSON" });
    Socket.made[1].onmessage({ data: new ArrayBuffer(2) });
    assert.deepEqual(lines, []);
  });

  it("stays away when another page has taken its place", () => {
    mock.timers.enable({ apis: ["setTimeout", "setInterval", "Date"] });
    const link = open();
    welcome(Socket.made[0]);
    Socket.made[0].die(4001);
    mock.timers.tick(60_000);
    assert.equal(link.status.state, "replaced");
    assert.equal(Socket.made.length, 1);
  });

  it("sends binary frames only while it is up", () => {
    const link = open();
    assert.equal(link.sendBinary(new ArrayBuffer(4)), false);
    welcome(Socket.made[0]);
    assert.equal(link.sendBinary(new ArrayBuffer(4)), true);
    assert.equal(Socket.made[0].last.byteLength, 4);
  });
});

describe("the server's clock", () => {
  it("is that of the least round trip, and forgets it after half a minute", () => {
    const clock = new Clock();
    clock.add(0, 100, 1_050);
    assert.equal(clock.offset, 1_000);
    clock.add(200, 210, 1_206);
    assert.equal(clock.offset, 1_001);
    clock.add(300, 900, 1_900);
    assert.equal(clock.offset, 1_001, "a slow answer says less");
    assert.equal(clock.tripMs, 10);
    clock.add(40_000, 40_040, 41_025);
    assert.equal(clock.offset, 1_005);
  });

  it("takes no nonsense", () => {
    const clock = new Clock();
    clock.add(10, 5, 0);
    clock.add(0, 10, Number.NaN);
    assert.equal(clock.offset, 0);
    assert.equal(clock.tripMs, Number.POSITIVE_INFINITY);
  });

  it("keeps a bounded number of answers", () => {
    const clock = new Clock();
    for (let i = 0; i < 10_000; i++) clock.add(i, i + 2, i + 101);
    assert.equal(clock.offset, 100);
  });
});

describe("the wait before another attempt", () => {
  it("doubles from a quarter of a second to five", () => {
    const waits = [1, 2, 3, 4, 5, 6, 7, 50].map((attempt) => backoffMs(attempt, 0.999_999));
    assert.deepEqual(waits.map(Math.round), [250, 500, 1000, 2000, 4000, 5000, 5000, 5000]);
    for (let attempt = 1; attempt < 20; attempt++) assert.ok(backoffMs(attempt, 0) >= 250);
  });
});
