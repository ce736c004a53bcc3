import assert from "node:assert/strict";
import { test } from "node:test";
import { translator } from "../../../services/console/page/js/strings.js";
import {
  answersOf,
  desiredIn,
  lastHeard,
  outcomeKey,
  paragraphs,
  progressOf,
  robotWords,
  screenOf,
} from "../../../services/console/page/js/study/model.js";
import {
  pairedCells,
  picturesOf,
  policyCells,
  withInterval,
} from "../../../services/console/page/js/study/numbers.js";
import { Secret } from "../../../services/console/page/js/study/secret.js";

const welcome = { settings: { study: true } };
const person = (participant, stage) => ({ participant, stage });
const t = translator("en", [{}]);

test("the screen follows the participant, and others wait", () => {
  const study = { active: person("ABC", "drawn"), last: null };
  assert.equal(screenOf({ me: "ABC", study, welcome }), "drawn");
  assert.equal(screenOf({ me: "XYZ", study, welcome }), "busy");
  assert.equal(screenOf({ me: null, study, welcome }), "busy");
  const free = { active: null, last: person("ABC", "thanks") };
  assert.equal(screenOf({ me: "ABC", study: free, welcome }), "thanks");
  assert.equal(screenOf({ me: null, study: free, welcome }), "welcome");
});

test("without a study, or before it is known, nothing is offered", () => {
  assert.equal(screenOf({ me: null, study: undefined, welcome }), "loading");
  const none = { settings: { study: false } };
  assert.equal(screenOf({ me: null, study: undefined, welcome: none }), "off");
});

test("progress counts what counts", () => {
  const at = (stage, trial) => ({ stage, total: 3, trial });
  assert.deepEqual(progressOf(at("running", { number: 2, practice: false })), [
    "study.progress",
    { n: 2, total: 3 },
  ]);
  assert.equal(progressOf(at("drawn", { practice: true }))[0], "study.practice");
  assert.equal(progressOf(at("questionnaire", { number: 3 })), null);
  assert.equal(progressOf(null), null);
});

test("the desired object is described with all its attributes in the scene's words", () => {
  const values = [{ name: "counter", spoken: "on the counter" }];
  const scene = {
    attributes: [
      { name: "location", values },
      { name: "color", values: [] },
    ],
    objects: [{ name: "white2", attributes: { color: "white", location: "counter" } }],
  };
  assert.deepEqual(desiredIn(scene, "white2").values, [
    { attribute: "location", spoken: "on the counter" },
    { attribute: "color", spoken: "white" },
  ]);
  assert.equal(desiredIn(scene, "gone"), null);
  assert.equal(desiredIn(undefined, "white2"), null);
});

test("the robot says nothing of an earlier interaction", () => {
  const dialogue = { decision: "ask", text: "Is it white?" };
  assert.equal(robotWords(dialogue, { said: 1 }), "Is it white?");
  assert.equal(robotWords(dialogue, { said: 0 }), "");
  assert.equal(robotWords({ decision: "wait", text: "All right." }, { said: 1 }), "");
});

test("what was heard is the latest since the start", () => {
  const lines = [
    { who: "person", text: "before", unix_ms: 1_000 },
    { who: "person", text: "the bowl", unix_ms: 20_000 },
    { who: "robot", text: "Is it white?", unix_ms: 21_000 },
    { who: "unmeant", text: "mumble", unix_ms: 22_000 },
  ];
  assert.deepEqual(lastHeard(lines, 15_000), { text: "mumble", meant: false });
  assert.deepEqual(lastHeard(lines.slice(0, 3), 15_000), { text: "the bowl", meant: true });
  assert.equal(lastHeard(lines.slice(0, 1), 15_000), null);
  assert.equal(lastHeard(undefined, 1), null);
});

test("answers are numbers or texts, and what is required is missed", () => {
  const items = [
    { id: "a", kind: "likert", required: true },
    { id: "b", kind: "number", required: false },
    { id: "c", kind: "text", required: false },
    { id: "d", kind: "choice", required: true },
  ];
  const given = { a: "4", b: "1,5", c: "  ", d: "left" };
  assert.deepEqual(
    answersOf(items, (id) => given[id]),
    {
      answers: { a: 4, b: 1.5, d: "left" },
      missing: [],
    },
  );
  assert.deepEqual(answersOf(items, (id) => ({ b: "many" })[id] ?? null).missing, ["a", "b", "d"]);
});

test("a text has paragraphs, and an outcome its words", () => {
  assert.deepEqual(paragraphs("One.\n\n Two\nlines.\n \n"), ["One.", "Two\nlines."]);
  assert.equal(outcomeKey({ outcome: "too_long" }), "study.outcome.too_long");
  assert.equal(outcomeKey({ outcome: null }), "study.outcome.fault");
});

test("numbers come with their intervals where there are any", () => {
  const write = (value) => value.toFixed(1);
  assert.deepEqual(withInterval(1, 0.5, 1.5, write), ["1.0", "[0.5, 1.5]"]);
  assert.deepEqual(withInterval(1, null, null, write), ["1.0", ""]);
  assert.deepEqual(withInterval(null, 0, 1, write), ["–", ""]);
  const mean = { n: 1, mean: 35.84, low: null, high: null };
  const group = {
    participants: 15,
    interactions: 45,
    success: 0.8,
    success_low: 0.662,
    success_high: 0.891,
    seconds: mean,
    questions: { ...mean, mean: 2 },
  };
  const cells = policyCells(group, t);
  assert.deepEqual(cells[2], ["80%", "[66.2%, 89.1%]"]);
  assert.deepEqual(cells[3], ["35.8", ""]);
  assert.equal(policyCells({ ...group, interactions: 0 }, t)[2][0], "–");
  const paired = { participants: 3, success: { mean: 0.1 }, seconds: mean, questions: mean };
  assert.deepEqual(pairedCells(paired, t)[1], ["+10%", ""]);
});

test("only pictures that show something are fetched", () => {
  const report = { all: { interactions: 0 }, questionnaire: [{ points: 5, mean: { n: 0 } }] };
  assert.deepEqual(picturesOf(report), []);
  report.all.interactions = 3;
  report.questionnaire[0].mean.n = 2;
  assert.equal(picturesOf(report).length, 4);
});

test("a page keeps its secret through a reload, and the next participant gets another", () => {
  const kept = new Map();
  const storage = { getItem: (key) => kept.get(key) ?? null, setItem: (k, v) => kept.set(k, v) };
  const first = new Secret(storage);
  assert.match(first.value, /^[0-9a-f]{32}$/);
  assert.equal(new Secret(storage).value, first.value);
  const before = first.value;
  assert.notEqual(first.renew(), before);
  const refusing = {
    getItem() {
      throw new Error("refused");
    },
  };
  assert.match(new Secret(refusing).value, /^[0-9a-f]{32}$/);
});
