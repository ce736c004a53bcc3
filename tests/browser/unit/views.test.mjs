import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { describe, it } from "node:test";
import { drawingOf } from "../../../services/console/page/js/model/drawing.js";
import { actOf, health, tone } from "../../../services/console/page/js/model/health.js";
import {
  density,
  likely,
  marks,
  rank,
  readable,
  strip,
  unlistedOf,
} from "../../../services/console/page/js/model/ranking.js";
import {
  actionWords,
  gist,
  proof,
  ranked,
  toCome,
} from "../../../services/console/page/js/model/reasons.js";
import { banner, mayResume, whoControls } from "../../../services/console/page/js/model/turn.js";
import { nowOf } from "../../../services/console/page/js/now.js";
import { escapeStops, stopper } from "../../../services/console/page/js/stop.js";
import { Store } from "../../../services/console/page/js/store.js";

const SCENE = {
  noun: "bowl",
  attributes: [{ name: "color", values: [{ name: "clear", spoken: "see-through" }] }],
  objects: [
    { name: "white", label: "white bowl" },
    { name: "clear", label: "clear bowl" },
    { name: "metal", label: "metal bowl" },
  ],
};

describe("the order of the cards", () => {
  it("is by probability, and of equals that of the scene", () => {
    assert.deepEqual(rank([], [0.2, 0.5, 0.2, 0.1]), [1, 0, 2, 3]);
    assert.deepEqual(rank([], [0.25, 0.25, 0.25, 0.25]), [0, 1, 2, 3]);
  });

  it("does not change for a hair", () => {
    assert.deepEqual(rank([0, 1], [0.499, 0.501]), [0, 1]);
    assert.deepEqual(rank([0, 1], [0.4, 0.6]), [1, 0]);
  });

  it("does not go wrong by many hairs", () => {
    const belief = Array.from({ length: 50 }, (_, i) => 0.003 * i);
    const order = rank(rank([], belief), belief);
    for (let i = 1; i < order.length; i++) {
      assert.ok(belief[order[i]] <= belief[order[i - 1]] + 0.004 + 1e-12);
    }
    assert.equal(new Set(order).size, 50);
  });

  it("follows objects that come and go", () => {
    assert.deepEqual(rank([3, 1, 0, 2], [0.5, 0.5]), [1, 0]);
    assert.deepEqual(rank([0], [0.1, 0.9]), [1, 0]);
  });
});

describe("many objects", () => {
  const belief = Array.from({ length: 100 }, () => 0.01);
  const order = [...belief.keys()];

  it("are cut to the likely ones, with what the others weigh", () => {
    const { shown, others, rest } = likely(order, belief, 12, new Set());
    assert.equal(shown.length, 12);
    assert.equal(others, 88);
    assert.ok(Math.abs(rest - 0.88) < 1e-9);
  });

  it("always show those that matter", () => {
    const { shown, others } = likely(order, belief, 12, new Set([99, 50]));
    assert.equal(shown.length, 12);
    assert.ok(shown.includes(99) && shown.includes(50));
    assert.equal(others, 88);
  });

  it("are not cut for one more", () => {
    assert.equal(likely(order.slice(0, 13), belief, 12, new Set()).others, 0);
  });

  it("keep their places in a line", () => {
    assert.deepEqual(strip([0.1, 0.5, 0.1, 0.3], 2), [1, 3]);
    assert.deepEqual(strip([0.3, 0.1, 0.3, 0.3], 2), [0, 2]);
    assert.deepEqual(strip([], 6), []);
  });

  it("are set closely", () => {
    assert.equal(density(6, 600), "roomy");
    assert.equal(density(6, 420), "medium");
    assert.equal(density(6, 300), "dense");
    assert.equal(density(20, null), "dense");
    assert.equal(density(0, 300), "roomy");
  });
});

describe("a probability", () => {
  it("is never rounded to certainty", () => {
    assert.deepEqual(readable(0.9999), { sign: ">", share: 0.99 });
    assert.deepEqual(readable(0.0001), { sign: "<", share: 0.01 });
    assert.deepEqual(readable(1), { sign: "", share: 1 });
    assert.deepEqual(readable(0), { sign: "", share: 0 });
    assert.deepEqual(readable(0.456), { sign: "", share: 0.46 });
  });
});

describe("objects that are not listed", () => {
  const scene = { count: 1000, objects: [{ name: "a" }, { name: "b" }] };

  it("have what is missing to the whole", () => {
    const { count, share } = unlistedOf(scene, { belief: { a: 0.5, b: 0.2 }, absent: 0.1 });
    assert.equal(count, 998);
    assert.ok(Math.abs(share - 0.2) < 1e-9);
  });

  it("are none in a small scene", () => {
    assert.deepEqual(unlistedOf({ objects: scene.objects }, { belief: { a: 0.1 } }), {
      count: 0,
      share: 0,
    });
  });
});

describe("marks on objects", () => {
  const of = ({ world = null, ...now }) => [...marks(SCENE, { is: "idle", ...now }, world)];

  it("mark the objects pointed at, fetched, held and handed over", () => {
    const question = { type: "point", object: "metal" };
    assert.deepEqual(of({ question }), [[2, "pointed"]]);
    assert.deepEqual(of({ order: { object: "clear", phase: "moving" } }), [[1, "picking"]]);
    assert.deepEqual(of({ order: { object: "clear", phase: "holding" } }), [[1, "held"]]);
    assert.deepEqual(of({ order: { object: "clear", phase: "done" } }), []);
    assert.deepEqual(of({ world: { objects: [[0], null, [0]], held: 0 } }), [
      [1, "delivered"],
      [0, "held"],
    ]);
    assert.deepEqual(of({ order: { object: "gone", phase: "moving" } }), []);
    const order = { object: "clear", phase: "moving" };
    assert.deepEqual(of({ is: "stopped", order }), [[1, "halted"]]);
    assert.deepEqual(of({ is: "disconnected", order, question }), []);
  });
});

describe("reasons", () => {
  const dialogue = {
    decision: "ask",
    text: "Sorry: is it big?",
    question: { type: "attr", attribute: "size", value: "big" },
    value: 41,
    belief: { white: 0.1, clear: 0.8, metal: 0.1 },
    alternatives: [
      { action: { type: "pick", object: "clear" }, value: -9 },
      { action: { type: "attr", attribute: "color", value: "clear" }, value: 40 },
      { action: { type: "wait" }, value: 41 },
    ],
  };
  const words = (action) => actionWords(action, SCENE);

  it("render typed actions by the strings, in the scene's words", () => {
    assert.deepEqual(words({ type: "pick", object: "clear" }).args, { object: "clear bowl" });
    assert.deepEqual(words({ type: "point", object: "gone" }).args, { object: "gone" });
    const asks = { type: "attr", attribute: "color", value: "clear" };
    assert.deepEqual(words(asks), { key: "action.attr", args: { value: "see-through" } });
    assert.deepEqual(words({ type: "not_here" }), { key: "action.not_here", args: {} });
  });

  it("have a string for every action in every language", () => {
    const types = ["wait", "not_here", "say", "pick", "point", "attr", "which"];
    for (const code of ["en", "de"]) {
      const path = `../../../services/console/page/strings/${code}.json`;
      const strings = JSON.parse(readFileSync(new URL(path, import.meta.url), "utf8"));
      for (const type of types) assert.ok(strings[`action.${type}`], `${code} ${type}`);
    }
  });

  it("are the best first, the chosen one before its equals, with bars of what they lose", () => {
    const rows = ranked(dialogue, null, 4);
    const types = rows.map((row) => row.action.type);
    assert.deepEqual(types, ["attr", "wait", "attr", "pick"]);
    assert.deepEqual(
      rows.map((row) => row.chosen),
      [true, false, false, false],
    );
    assert.deepEqual(
      rows.map((row) => row.loss),
      [0, 0, 1, 50],
    );
    assert.deepEqual(
      rows.map((row) => row.length),
      [0, 0, 0.02, 1],
    );
    assert.equal(ranked(dialogue, null, 3)[2].length, 1, "of those that are shown");
  });

  it("have next to no bar where what is lost is shown as nothing", () => {
    const equal = { action: { type: "pick", object: "white" }, value: 40.99 };
    const rows = ranked({ ...dialogue, alternatives: [equal] }, null, 4);
    assert.ok(rows[1].length < 0.02, `${rows[1].length}`);
  });

  it("of a pick name what is picked", () => {
    const picks = { ...dialogue, decision: "pick", alternatives: [] };
    assert.deepEqual(ranked(picks, "clear", 4)[0].action, { type: "pick", object: "clear" });
    assert.deepEqual(ranked(picks, "metal", 4)[0].action, { type: "pick", object: "metal" });
    assert.equal(ranked(picks, "clear", 4)[0].length, 0);
  });

  it("say what is proven", () => {
    assert.equal(proof(41, null), null);
    assert.deepEqual(proof(41.2, [41.19, 41.21]), { key: "why.proven", args: { value: 41.2 } });
    assert.deepEqual(proof(30, [28.04, 33.06]), {
      key: "why.bounded",
      args: { low: 28, high: 33.1 },
    });
  });

  it("begin with what an answer tells, or how sure a pick is", () => {
    const even = { ...dialogue, belief: { white: 0.5, clear: 0.5, metal: 0.001 } };
    const colored = ({ name }) => ({ ...SCENE.objects[0], name, attributes: { color: name } });
    const scene = { ...SCENE, objects: SCENE.objects.map(colored) };
    const split = (all, yes) => ({ key: "why.split", args: { all, yes, no: all - yes } });
    const about = (question) => gist({ ...even, question }, null, scene);
    const color = { type: "attr", attribute: "color", value: "clear" };
    assert.deepEqual(about(color), split(2, 1), "of those that are likely");
    assert.deepEqual(about({ type: "point", object: "white" }), split(2, 1));
    const open = { type: "which", attribute: "color" };
    assert.deepEqual(about(open), { key: "why.open", args: { most: 1, all: 2 } });
    const one = { ...even, belief: { white: 1, clear: 0, metal: 0 } };
    assert.equal(gist(one, null, SCENE), null, "nothing to tell apart");
    const picks = { ...dialogue, decision: "pick" };
    assert.deepEqual(gist(picks, "clear", SCENE).args, { object: "clear bowl", p: 0.8 });
    assert.equal(gist(picks, "gone", SCENE), null);
    assert.equal(gist({ ...dialogue, belief: undefined }, null, SCENE), null, "as in the history");
  });

  it("say how many questions are to come", () => {
    assert.equal(toCome(0).key, "why.none");
    assert.equal(toCome(Number.NaN).key, "why.none");
    assert.deepEqual(toCome(1.234), { key: "why.expected", args: { n: 1.2 } });
  });
});

/** What the page knows, as the views' one state. */
const nowWith = (sections, isLost = false) => nowOf({ get: (name) => sections[name] }, isLost);

describe("the one state", () => {
  const up = { link: { state: "up" }, turn: { state: "idle" }, arm: { phase: "idle" } };
  const old = { interaction: 1, object: "metal", phase: "done", outcome: "delivered" };
  const picks = { interaction: 2, decision: "pick", belief: { white: 0.1, clear: 0.9 } };
  const asks = { interaction: 2, decision: "ask", question: { type: "which", attribute: "color" } };

  it("is the gravest that holds", () => {
    const all = { ...up, dialogue: asks, arm: { ...old, object: "clear", phase: "moving" } };
    const down = { ...all, turn: { state: "down" } };
    const stopped = { ...down, arm: { ...all.arm, stopped: true } };
    const cases = [
      [nowWith(stopped, true), "disconnected"],
      [nowWith(stopped), "stopped"],
      [nowWith(down), "held"],
      [nowWith(all), "fetching"],
      [nowWith({ ...up, dialogue: asks }), "asking"],
      [nowWith(up), "idle"],
    ];
    for (const [{ is }, expected] of cases) assert.equal(is, expected);
  });

  it("names what this dialogue fetches, not what the arm fetched before", () => {
    const now = nowWith({ ...up, dialogue: picks, arm: old });
    assert.deepEqual([now.aim, now.order], ["clear", null]);
    const taken = { ...old, interaction: 2, object: "white", phase: "moving" };
    assert.equal(nowWith({ ...up, dialogue: picks, arm: taken }).aim, "white");
    const ended = { interaction: 0, last: { interaction: 1 } };
    assert.deepEqual(nowWith({ ...up, dialogue: ended, arm: old }).order, old);
  });

  it("names the service that is missing", () => {
    const services = [
      { name: "recorder", state: "failed" },
      { name: "policy", state: "held" },
    ];
    const held = { ...up, turn: { state: "down" }, group: { services } };
    assert.deepEqual(nowWith(held).service, { name: "policy", state: "held" });
    assert.equal(nowWith({ ...held, group: undefined }).service?.name, "arm");
    assert.equal(nowWith(up).service, null);
  });

  it("knows nobody in control without a connection", () => {
    const mine = { ...up, control: { operator: "v1" }, welcome: { viewer: "v1" } };
    assert.equal(nowWith(mine).who, "mine");
    assert.equal(nowWith(mine, true).who, "unknown");
  });
});

describe("the sign of the turn", () => {
  const up = { state: "up" };
  const of = (link, turn, arm, control, isLost = false) =>
    banner(nowWith({ link, turn, arm, control, welcome: { viewer: "v1" } }, isLost)).key;

  it("knows nothing without a connection", () => {
    assert.equal(of({ state: "down" }, { state: "asked" }, {}, null, true), "offline");
    assert.equal(of({ state: "connecting" }, undefined), "connecting");
    assert.equal(of({ state: "replaced" }, { state: "asked" }), "replaced");
    assert.equal(of(up, undefined), "connecting");
  });

  it("shows each state, and a stop before any of them", () => {
    for (const state of ["idle", "listening", "hearing", "asked", "understanding", "down"]) {
      assert.equal(of(up, { state }, {}), state);
      assert.equal(of(up, { state }, { stopped: true }), "stopped");
      assert.equal(of(up, { state }, { stopped: true, moving: true }), "stopping");
    }
    assert.equal(of(up, { state: "unheard of" }, {}), "idle");
  });

  it("is the operator's turn for viewers", () => {
    for (const state of ["idle", "listening", "hearing", "asked", "speaking"]) {
      for (const other of [{ asked_by: "v1" }, { away: true }, {}]) {
        assert.equal(of(up, { state }, {}, { operator: "v2", ...other }), `theirs_${state}`);
      }
      assert.equal(of(up, { state }, {}, { operator: "v1" }), state);
      assert.equal(of(up, { state }, {}, { operator: null }), state);
    }
    assert.equal(of(up, { state: "moving" }, {}, { operator: "v2" }), "moving");
    assert.equal(of(up, { state: "asked" }, { stopped: true }, { operator: "v2" }), "stopped");
  });

  it("shows the operator", () => {
    const me = { viewer: "v1" };
    assert.equal(whoControls(undefined, me), "unknown");
    assert.equal(whoControls({ operator: "v1" }, me), "mine");
    assert.equal(whoControls({ operator: null }, me), "free");
    assert.equal(whoControls({ operator: "v2" }, me), "theirs");
    assert.equal(whoControls({ operator: "v2", asked_by: "v1" }, me), "asked");
    assert.equal(whoControls({ operator: "v2", away: true }, me), "away");
  });
});

describe("how an object is drawn", () => {
  const of = (attributes, noun = "thing", size = undefined) =>
    drawingOf({ attributes, size }, noun);

  it("follows its words", () => {
    const bowl = of({ color: "clear", material: "plastic", size: "big" }, "bowl");
    assert.deepEqual([bowl.form, bowl.finish, bowl.scale], ["bowl", "glass", 1]);
    assert.equal(of({ kind: "wrench", color: "red" }, "tool").form, "wrench");
    assert.equal(of({ color: "metallic", size: "small" }, "bowl").finish, "shiny");
    assert.notEqual(of({ color: "red" }).fill, of({ color: "blue" }).fill);
    assert.equal(of({ kind: "coffee mug" }).form, "cup");
    assert.equal(of({}, "blocks").form, "box");
    assert.equal(of({ color: "red", location: "tray" }, "block").form, "box", "not what it is in");
  });

  it("falls back on its size, and on a box", () => {
    assert.equal(of({}, "thing", [0.2, 0.02, 0.02]).form, "rod");
    assert.equal(of({}, "thing", [0.05, 0.05, 0.2]).form, "can");
    assert.equal(of({}, "thing", [0.2, 0.2, 0.02]).form, "plate");
    assert.equal(of({ shape: "round" }).form, "ball");
    assert.equal(of({ colour: "octarine" }).form, "box");
    assert.equal(of({ constructor: "toString" }).form, "box");
  });
});

describe("health in a line", () => {
  const of = (...states) => health(states.map((state, i) => ({ name: `s${i}`, state })));

  it("names the gravest", () => {
    assert.deepEqual(of("ready", "ready"), { tone: "good", key: "health.good", args: { n: 2 } });
    assert.equal(of("ready", "starting").args.names, "s1");
    assert.deepEqual(of("failed", "short", "held").args, { names: "s0", n: 1 });
    assert.equal(of("short", "held", "starting").key, "health.short");
    assert.equal(of().key, "services.none");
    assert.equal(health(undefined).tone, "busy");
  });

  it("does not call a held service failed", () => {
    const looks = ["held", "starting", "short", "failed"].map((state) => tone(state));
    assert.equal(new Set(looks).size, 4);
    assert.deepEqual(
      ["held", "down", "short", "failed", "ready"].map((state) => actOf(state)),
      ["release", "start", "retry", "retry", "restart"],
    );
  });

  it("has words for every state in every language", () => {
    const states = "down waiting starting ready stopping restarting short held failed".split(" ");
    for (const code of ["en", "de"]) {
      const path = `../../../services/console/page/strings/${code}.json`;
      const strings = JSON.parse(readFileSync(new URL(path, import.meta.url), "utf8"));
      assert.equal(new Set(states.map((state) => strings[`service.${state}`])).size, 9, code);
      for (const state of states) {
        assert.ok(strings[`services.act.${actOf(state)}`], `${code} ${state}`);
        assert.ok(state === "ready" || strings[`alarm.why.${state}`], `${code} ${state}`);
      }
    }
  });
});

describe("stop", () => {
  /** A link that the test plays. */
  function play(isUp) {
    const heard = {};
    const link = {
      isUp,
      sent: [],
      reconnects: 0,
      on: (what, f) => {
        heard[what] = f;
      },
      reconnect: () => {
        link.reconnects += 1;
      },
      do: (verb) => {
        const error = (code) => Object.assign(new Error(code), { code });
        if (!link.isUp) return Promise.reject(error("down"));
        return new Promise((resolve, reject) => {
          link.sent.push({ verb, ok: resolve, fail: (code) => reject(error(code)) });
        });
      },
      go: () => {
        link.isUp = false;
        heard.status({ state: "down" });
      },
      come: () => {
        link.isUp = true;
        heard.status({ state: "up" });
      },
    };
    const store = new Store();
    const clock = { now: 0 };
    const press = stopper({ link, store, now: () => clock.now });
    return { clock, link, press, store, state: () => store.get("stop").state };
  }

  it("is sent in the same moment, and quiet when it is confirmed", async () => {
    const { link, press, state } = play(true);
    const pressed = press();
    assert.deepEqual([link.sent.length, state()], [1, "sent"]);
    link.sent[0].ok({});
    await pressed;
    assert.equal(state(), "idle");
    link.come();
    assert.equal(link.sent.length, 1, "it is not sent twice");
  });

  it("says that it was not delivered, and is sent when the connection is back", async () => {
    const { link, press, state } = play(false);
    await press();
    assert.equal(state(), "undelivered");
    link.come();
    assert.deepEqual([link.sent.length, state()], [1, "sent"]);
    link.sent[0].ok({});
    await new Promise(setImmediate);
    assert.equal(state(), "idle");
  });

  it("connects again where no answer comes", async () => {
    const { link, press, state } = play(true);
    const pressed = press();
    link.sent[0].fail("late");
    await pressed;
    assert.deepEqual([link.reconnects, state()], [1, "undelivered"]);
    link.come();
    assert.deepEqual([link.sent.length, state()], [2, "undelivered"], "the warning stays");
    link.sent[1].ok({});
    await new Promise(setImmediate);
    assert.equal(state(), "idle");
  });

  it("leaves a stop that the server repeats to the server, with the warning", async () => {
    const { link, press, store, state } = play(true);
    const pressed = press();
    store.set("motion", { unconfirmed: { why: "held" } });
    link.sent[0].fail("refused");
    await pressed;
    link.come();
    assert.deepEqual([state(), link.sent.length], ["idle", 1]);
    const again = press();
    assert.equal(link.sent.length, 2, "it can be pressed again");
    link.sent[1].ok({});
    await again;
  });

  it("sends it again to a server that was restarted before the arm confirmed", async () => {
    const { link, press, store, state } = play(true);
    const pressed = press();
    store.set("motion", { unconfirmed: { why: "moving" } });
    link.sent[0].fail("refused");
    await pressed;
    link.go();
    assert.equal(state(), "undelivered");
    link.come();
    assert.deepEqual([state(), link.sent.length], ["sent", 2]);
    link.sent[1].ok({});
    await new Promise(setImmediate);
    assert.equal(state(), "idle");
    link.go();
    link.come();
    assert.equal(link.sent.length, 2, "a confirmed stop is not repeated");
  });

  it("takes the connection's loss for no confirmation, whatever the server said before", async () => {
    const { link, press, store, state } = play(true);
    store.set("motion", { unconfirmed: { why: "held" } });
    const pressed = press();
    link.go();
    link.sent[0].fail("lost");
    await pressed;
    assert.equal(state(), "undelivered");
    link.come();
    assert.equal(link.sent.length, 2);
  });

  it("is over once the server reports that it is confirmed", async () => {
    const { link, press, store } = play(true);
    const pressed = press();
    store.set("motion", { unconfirmed: { why: "held" } });
    link.sent[0].fail("refused");
    await pressed;
    store.set("motion", { unconfirmed: null });
    link.go();
    link.come();
    assert.equal(link.sent.length, 1);
  });

  it("shows its age where it is delivered late", async () => {
    const { clock, link, press, store } = play(false);
    await press();
    clock.now = 20_000;
    await press();
    clock.now = 40_000;
    link.come();
    link.sent[0].ok({});
    await new Promise(setImmediate);
    assert.deepEqual(store.get("stop"), { state: "idle", ageMs: 40_000 });
    press();
    clock.now = 40_100;
    link.sent[1].ok({});
    await new Promise(setImmediate);
    assert.deepEqual(store.get("stop"), { state: "idle" });
  });

  it("repeats a stop that the server could not take, and warns", async (test) => {
    test.mock.timers.enable({ apis: ["setTimeout"] });
    const { link, press, state } = play(true);
    const pressed = press();
    link.sent[0].fail("refused");
    await pressed;
    assert.equal(state(), "undelivered");
    test.mock.timers.tick(500);
    assert.equal(link.sent.length, 2);
    link.sent[1].ok({});
    await new Promise(setImmediate);
    assert.equal(state(), "idle");
  });

  it("is two presses of Escape, or one while the arm moves", () => {
    assert.equal(escapeStops(null, 1_000, false), false);
    assert.equal(escapeStops(600, 1_000, false), true);
    assert.equal(escapeStops(0, 1_000, false), false);
    assert.equal(escapeStops(null, 1_000, true), true);
  });
});

describe("an arm that is stopped", () => {
  it("is released by the operator, and in a study by every page but the participant's", () => {
    const welcome = { viewer: "v1" };
    assert.equal(mayResume({ operator: "v1" }, welcome), true);
    assert.equal(mayResume({ operator: "v2" }, welcome), false);
    assert.equal(mayResume({ operator: null }, welcome), false);
    assert.equal(mayResume({ operator: "v1", participant: true }, welcome), false);
    assert.equal(mayResume({ operator: "v2", participant: true }, welcome), true);
    assert.equal(mayResume(undefined, undefined), false);
  });
});

describe("services without a connection", () => {
  it("are unknown, whatever they were", () => {
    const services = [{ name: "arm", state: "ready", restarts: 0 }];
    assert.deepEqual([health(services).tone, health(services, true).tone], ["good", "unknown"]);
  });
});
