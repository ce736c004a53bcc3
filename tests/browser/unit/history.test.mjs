// The history: places in an interaction, words, and files that are shared.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { describe, it } from "node:test";
import { linked, linkTo } from "../../../services/console/page/js/history/address.js";
import { dayOf } from "../../../services/console/page/js/history/list.js";
import {
  actorOf,
  endWords,
  eventWords,
  fileOf,
  interactionOf,
  move,
  reasonsOf,
  stepsOf,
} from "../../../services/console/page/js/history/model.js";
import { Source } from "../../../services/console/page/js/history/source.js";
import { translator } from "../../../services/console/page/js/strings.js";

const english = JSON.parse(
  readFileSync(new URL("../../../services/console/page/strings/en.json", import.meta.url), "utf8"),
);
const decision = (type, text) => ({
  type,
  text,
  prompt: text.length,
  presentation: 1,
  question: { type: "none" },
  pick: null,
  value_s: 3,
  bounds_s: [2, 4],
  expected_questions: 1,
  alternatives: [{ action: { type: "wait" }, value_s: 1 }],
});
const thought = (belief, type, text) => ({ belief, absent: 0, decision: decision(type, text) });
const heard = (text) => ({
  type: "heard",
  text,
  readings: [{ text, weight: 1 }],
  answers: [{ question: "Is it white?", share: 0.5 }],
});
const arm = (phase, outcome = "pending", cause = "phase") => ({
  type: "arm",
  cause: { type: cause },
  pick: { interaction: 4, attempt: 1, object: "b", task: "fetch", phase, outcome },
});
const past = {
  interaction: 4,
  unix_ms: 1_700_000_000_000,
  whole: true,
  objects: [
    { name: "a", label: "white bowl" },
    { name: "b", label: "white bowl 2" },
  ],
  moments: [
    { after_ms: 0, event: heard("the bowl"), thought: thought([0.5, 0.5], "ask", "Is it white?") },
    {
      after_ms: 900,
      event: { type: "quiet" },
      thought: thought([0.5, 0.5], "ask", "Is it white?"),
    },
    { after_ms: 2_000, event: heard("no"), thought: thought([0, 1], "pick", "I will get it.") },
    { after_ms: 2_100, event: arm("moving"), thought: null },
    {
      after_ms: 6_000,
      event: { type: "pick_ended", outcome: "delivered" },
      thought: thought([0, 1], "say", "Here it is."),
    },
    { after_ms: 8_000, event: arm("done", "delivered", "rested"), thought: null },
  ],
  left_out: 0,
  end: {
    outcome: "delivered",
    object: { name: "b", label: "white bowl 2" },
    questions: 1,
    duration_s: 6,
  },
};

describe("an interaction", () => {
  it("has a place for each moment, and its end where it was", () => {
    const steps = stepsOf(past);
    const kinds = steps.map(({ event }) => event.type);
    assert.deepEqual(kinds, ["heard", "quiet", "heard", "arm", "pick_ended", "end", "arm"]);
    const lines = steps.map(({ line }) => line);
    assert.deepEqual(lines, ["Is it white?", "", "I will get it.", "", "Here it is.", "", ""]);
    assert.deepEqual(steps[2].before, [0.5, 0.5]);
    assert.deepEqual(steps[3].thought.belief, [0, 1], "what it believed last");
    assert.equal(stepsOf({ ...past, end: null }).length, 6);
    assert.deepEqual(stepsOf({ ...past, moments: [], end: null }), []);
  });

  it("has one line for a stop and one for its release", () => {
    const motion = (order) => ({ ...arm("moving"), cause: { type: "motion", order } });
    const at = (event, thought = null) => ({ after_ms: 1, event, thought });
    const known = thought([0, 1], "pick", "I will get it.");
    const moments = [
      at(motion("stop")),
      at({ type: "stopped" }, known),
      at(motion("resume")),
      at({ type: "released" }, known),
      at(motion("stop")),
    ];
    const steps = stepsOf({ ...past, moments, end: null });
    const keys = steps.map(({ event }) => eventWords(event, past).key);
    const told = ["history.event.stopped", "history.event.released", "history.arm.stop"];
    assert.deepEqual(keys, told, "the last one was not written down by the dialogue");
    const actors = steps.map(({ event }) => actorOf(event));
    assert.deepEqual(actors, ["stop", "release", "stop"]);
  });

  it("is walked to its ends and no further", () => {
    assert.deepEqual([move(6, 0, -1), move(6, 0, 1), move(6, 5, 1), move(6, 9, 0)], [0, 1, 5, 5]);
  });

  it("has words for everything that can happen", () => {
    const has = ({ key }) => assert.ok(key in english, key);
    const types = "silence quiet reconfigured objects stopped released recovered heard".split(" ");
    for (const type of types) has(eventWords({ type }, past));
    const outcomes =
      "pending delivered unreachable interrupted cancelled missed blocked put_back vanished kept";
    for (const outcome of outcomes.split(" ")) {
      has(eventWords({ type: "pick_ended", outcome }, past));
      has(eventWords(arm("done", outcome, "ended"), past));
    }
    for (const phase of "idle accepted moving closing holding returning".split(" ")) {
      has(eventWords(arm(phase), past));
      if (phase === "idle") continue;
      const back = arm(phase);
      back.pick.task = "put_back";
      has(eventWords(back, past));
    }
    for (const cause of ["missed", "rested", "blocked"])
      has(eventWords(arm("moving", "pending", cause), past));
    for (const order of ["stop", "resume"]) {
      has(eventWords({ ...arm("moving"), cause: { type: "motion", order } }, past));
    }
    const ends = "delivered refused failed cancelled abandoned scene_changed not_here".split(" ");
    for (const outcome of ends) has(endWords({ ...past.end, outcome }));
    has(endWords(null));
    assert.equal(eventWords(arm("moving"), past).args.object, "white bowl 2");
  });

  it("has its reasons in the form of the page's own", () => {
    const { value, bounds, alternatives } = reasonsOf(decision("ask", "Is it white?"));
    assert.deepEqual([value, bounds], [3, [2, 4]]);
    assert.deepEqual(alternatives, [{ action: { type: "wait" }, value: 1 }]);
  });
});

describe("a shared file", () => {
  const from = { group: "kitchen", version: "1.0.0" };

  it("holds the whole interaction", () => {
    const read = interactionOf(fileOf(past, from));
    const { format, group, version, ...rest } = read;
    assert.deepEqual(rest, past);
    assert.deepEqual([format, group, version], ["whichone.interaction/1", "kitchen", "1.0.0"]);
  });

  it("is recognised, whatever else there is", () => {
    const broken = [
      { moments: [{}] },
      { moments: null },
      { objects: [{ name: "a" }] },
      { format: "other" },
      { end: { outcome: 5 } },
      { interaction: "4" },
      { moments: [{ after_ms: 0, event: arm(5), thought: null }] },
      { moments: [{ after_ms: 0, event: heard("no"), thought: { belief: ["x"] } }] },
    ];
    for (const change of broken) {
      const file = JSON.stringify({ ...JSON.parse(fileOf(past, from)), ...change });
      assert.equal(interactionOf(file), null, JSON.stringify(change));
    }
    for (const text of ["", "[]", "null", "{", '{"format":"whichone.interaction/1"}']) {
      assert.equal(interactionOf(text), null, text);
    }
  });
});

describe("an address", () => {
  it("names an interaction, the history, or neither", () => {
    assert.deepEqual(["#history=12", "#history", "", "#else", "#history=x"].map(linked), [
      12,
      0,
      null,
      null,
      null,
    ]);
    assert.deepEqual([linkTo(12), linkTo(0)], ["#history=12", "#history"]);
  });
});

describe("the list", () => {
  it("says near days in words", () => {
    const t = translator("en", [english]);
    const now = new Date(2026, 4, 3, 0, 30).getTime();
    const hours = (n) => now - n * 3_600_000;
    assert.equal(dayOf(now, t, now), "Today");
    assert.equal(dayOf(hours(1), t, now), "Yesterday");
    assert.equal(dayOf(hours(48), t, now), "Friday, May 1, 2026");
    assert.equal(dayOf(null, t, now), "Time unknown");
  });

  it("is fetched as far as it is looked at, and keeps what it has", async () => {
    let total = 120;
    const asked = [];
    globalThis.fetch = async (path) => {
      const query = new URL(path, "http://x").searchParams;
      const before = Number(query.get("before") ?? total + 1);
      asked.push(before);
      const limit = Number(query.get("limit"));
      const count = Math.max(0, Math.min(limit, before - 1));
      const interactions = Array.from({ length: count }, (_, n) => ({
        interaction: before - 1 - n,
      }));
      const json = async () => ({ interactions, total, oldest: { interaction: 1 } });
      return { ok: true, status: 200, json };
    };
    const source = new Source();
    await source.refresh();
    await Promise.all([source.more(), source.more()]);
    assert.deepEqual(asked, [121, 71], "one request at a time");
    assert.equal(source.list.length, 100);
    total = 121;
    await source.refresh();
    assert.deepEqual([source.list[0].interaction, source.list.length], [121, 101]);
    await source.more();
    assert.ok(source.isComplete && source.list.at(-1).interaction === 1);
    await source.more();
    // After a long absence more is new than one answer holds.
    total = 400;
    await source.refresh();
    assert.deepEqual([source.list[0].interaction, source.list.length], [400, 50]);
  });
});
