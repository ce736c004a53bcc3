// What holding and clicking come to, what the button says, what the loudspeaker does.

import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { test } from "node:test";

const PAGE = "../../../services/console/page";
const VOICE = `${PAGE}/js/voice`;
const { idle, pressed, talks } = await import(`${VOICE}/press.js`);
const { sign } = await import(`${VOICE}/sign.js`);
const { keyOf, offsetS, plan } = await import(`${VOICE}/schedule.js`);
const { microphoneFault, recognitionFault, standingFault } = await import(`${VOICE}/faults.js`);
const { DEFAULTS, isEchoFree, keep, kept } = await import(`${VOICE}/choices.js`);
const { utterance } = await import(`${VOICE}/recognition.js`);

/** Whether the person talks after each of these events, `[event, page time]` each. */
function play(...events) {
  let state = idle();
  return events.map(([event, at]) => {
    state = pressed(state, event, at);
    return talks(state);
  });
}

test("holding talks until it is released", () => {
  assert.deepEqual(play(["down", 0], ["up", 900]), [true, false]);
});

test("a click talks until the next one: click, speak, click", () => {
  const results = play(["down", 0], ["up", 100], ["down", 2_000], ["up", 2_100], ["down", 3_000]);
  assert.deepEqual(results, [true, true, false, false, true]);
});

test("a screen reader's click does the same, and leaving the page ends it", () => {
  assert.deepEqual(play(["click", 0], ["click", 1_000]), [true, false]);
  assert.deepEqual(play(["down", 0], ["cancel", 100], ["up", 200]), [true, false, false]);
});

test("the button agrees with whose turn it is", () => {
  const known = { is: "idle", turn: "listening", talks: false, latched: false, handsFree: false };
  const of = (change) =>
    sign({ ...known, isOpening: false, isOpen: false, standing: null, ...change });
  assert.equal(of({}).key, "idle");
  assert.equal(of({ talks: true }).key, "talking");
  assert.equal(of({ talks: true, latched: true }).key, "latched");
  assert.equal(of({ talks: true, turn: "hearing" }).state, "hearing");
  assert.equal(of({ turn: "hearing" }).key, "idle", "another user is speaking");
  assert.equal(of({ turn: "understanding" }).key, "understanding");
  assert.equal(of({ handsFree: true, isOpen: true }).key, "open");
  assert.equal(of({ isOpening: true }).key, "opening");
  assert.equal(of({ standing: "voice.fault.recogniser" }).key, "unable");
  assert.deepEqual(
    ["disconnected", "held"].map((is) => of({ is })).map(({ key, disabled }) => [key, disabled]),
    [
      ["off", true],
      ["held", true],
    ],
  );
});

const line = { prompt: 4, presentation: 1, url: "/voice/line-4-1.wav", began_ms: 0 };
const speaking = { ...line, state: "speaking" };
const silent = { playing: "", hushed: "", muted: false };

test("what the robot says is played once, from when it says it", () => {
  assert.deepEqual(plan({ ...silent, speaking }), { stop: false, start: speaking });
  assert.deepEqual(plan({ ...silent, speaking, playing: "4-1" }), { stop: false, start: null });
  const ended = { ...line, state: "ended" };
  assert.deepEqual(plan({ ...silent, speaking: ended }), { stop: false, start: null });
  assert.ok(!plan({ ...silent, speaking: ended, playing: "4-1" }).stop, "it may end here, too");
  assert.equal(plan({ ...silent, speaking: { ...speaking, url: null } }).start, null);
  assert.equal(keyOf(null), "");
});

test("it falls silent at once when it was broken off, replaced, hushed or muted", () => {
  const stops = (change) => plan({ ...silent, playing: "4-1", speaking, ...change }).stop;
  assert.ok(stops({ speaking: { ...line, state: "interrupted" } }));
  assert.ok(stops({ hushed: "4-1" }));
  assert.ok(stops({ muted: true }));
  assert.ok(stops({ speaking: null }));
  const ended = { ...line, state: "ended", ended_ms: 1_000 };
  assert.ok(stops({ speaking: ended, lengthS: 3 }), "it ended before its sound");
  assert.ok(!stops({ speaking: ended, lengthS: 1.2 }));
  const next = { ...speaking, prompt: 5 };
  const replaced = plan({ ...silent, playing: "4-1", speaking: next });
  assert.deepEqual(replaced, { stop: true, start: next });
  assert.equal(plan({ ...silent, speaking, hushed: "4-1" }).start, null);
});

test("who comes late hears the rest, and who is hardly late all of it", () => {
  assert.equal(offsetS(1_000, 1_200, 2), 0);
  assert.equal(offsetS(1_000, 1_900, 2), 0.9);
  assert.equal(offsetS(1_000, 3_100, 2), null);
});

test("every fault has a text with help in every language", async () => {
  const devices = ["NotAllowedError", "NotFoundError", "NotReadableError", "TypeError"];
  const codes = ["network", "not-allowed", "service-not-allowed", "audio-capture", "whatever"];
  const faults = [
    ...devices.map((name) => microphoneFault({ name })),
    ...codes.map(recognitionFault),
    standingFault({ secure: false }),
    standingFault({ secure: true, state: "off" }),
  ];
  assert.equal(standingFault({ secure: true, state: "ready", recogniser: true }), null);
  for (const language of ["en", "de"]) {
    const file = new URL(`${PAGE}/strings/${language}.json`, import.meta.url);
    const strings = JSON.parse(await readFile(file, "utf8"));
    for (const key of faults) assert.ok(strings[key]?.length > 40, `${language}: ${key}`);
  }
});

test("choices are kept, and invalid ones are ignored", () => {
  const items = new Map();
  const storage = { getItem: (key) => items.get(key) ?? null, setItem: (k, v) => items.set(k, v) };
  assert.deepEqual(kept(storage), DEFAULTS);
  keep(storage, { ...DEFAULTS, headset: true });
  assert.deepEqual(kept(storage), { ...DEFAULTS, headset: true });
  for (const bad of ["{", "null", '{"engine":"cloud","headset":"yes"}']) {
    storage.setItem("whichone.voice", bad);
    assert.deepEqual(kept(storage), DEFAULTS);
  }
  assert.deepEqual(kept(null), DEFAULTS);
});

test("the robot may be interrupted where the browser really takes its voice out", () => {
  assert.ok(isEchoFree(DEFAULTS, { echoCancellation: true }, false));
  assert.ok(!isEchoFree(DEFAULTS, { echoCancellation: true }, true), "it sounds elsewhere then");
  assert.ok(!isEchoFree(DEFAULTS, {}, false), "wished for is not measured");
  assert.ok(isEchoFree({ ...DEFAULTS, headset: true }, {}, true));
});

test("a browser's words come with what else they may have been", () => {
  const results = [
    { transcript: " the white one ", confidence: 0.8 },
    { transcript: "the wide one", confidence: 0 },
    { transcript: "the white one", confidence: 0.1 },
    { transcript: " ", confidence: 0.1 },
  ];
  const said = utterance(results);
  assert.equal(said.text, "the white one");
  assert.equal(said.alternatives.length, 1);
  assert.ok(Math.abs(said.alternatives[0].weight - 0.2) < 1e-9);
  assert.equal(utterance([{ transcript: "", confidence: 0 }]), null);
});
