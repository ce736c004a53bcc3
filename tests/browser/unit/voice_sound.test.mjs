// How the page cuts, times and packs what the microphone hears.

import assert from "node:assert/strict";
import { test } from "node:test";

const VOICE = "../../../services/console/page/js/voice";
const { Chunker, levelDb, meterShare, QUIETEST_DB } = await import(`${VOICE}/sound.js`);
const { Resampler } = await import(`${VOICE}/resampler.js`);
const { SampleClock } = await import(`${VOICE}/clock.js`);
const { encode } = await import(`${VOICE}/frame.js`);
const { PreRoll } = await import(`${VOICE}/preroll.js`);
const { VoiceStream } = await import(`${VOICE}/stream.js`);

const tone = (hz, rate, seconds) =>
  Float32Array.from({ length: rate * seconds }, (_, n) => Math.sin((2 * Math.PI * hz * n) / rate));

test("samples come in pieces of one length, none lost, clipped at full scale", () => {
  const chunker = new Chunker(4);
  const pieces = [];
  const take = (piece, behind) => pieces.push([[...piece], behind]);
  chunker.push(Float32Array.of(0, 1, -1), take);
  assert.deepEqual(pieces, []);
  chunker.push(Float32Array.of(2, -3, 0.5, 0, 0, 0.25), take);
  assert.deepEqual(pieces, [
    [[0, 32767, -32768, 32767], 5],
    [[-32768, 16384, 0, 0], 1],
  ]);
  assert.equal(chunker.pending, 1);
});

test("loudness is that of the samples", () => {
  assert.equal(levelDb(new Int16Array(100)), QUIETEST_DB);
  assert.ok(Math.abs(levelDb(new Int16Array(100).fill(32767))) < 0.01);
  assert.ok(Math.abs(levelDb(new Int16Array(100).fill(3277)) + 20) < 0.01);
  assert.deepEqual([-100, -35, 0].map(meterShare), [0, 0.5, 1]);
});

for (const from of [16_000, 44_100, 48_000]) {
  test(`a tone goes from ${from} to 16000 samples a second as it was`, () => {
    const resampler = new Resampler(from, 16_000);
    const sound = tone(440, from, 1);
    const out = [];
    for (let n = 0; n < sound.length; n += 128)
      out.push(...resampler.push(sound.slice(n, n + 128)));
    assert.ok(Math.abs(out.length - 16_000) < 60, `${out.length} samples`);
    const expected = tone(440, 16_000, 1);
    const errors = out.slice(200, 15_000).map((sample, n) => Math.abs(sample - expected[n + 200]));
    assert.ok(Math.max(...errors) < 0.01, `off by ${Math.max(...errors)}`);
  });
}

test("what the lower rate cannot hold does not come back as something else", () => {
  const out = new Resampler(48_000, 16_000).push(tone(11_000, 48_000, 1));
  const loudest = Math.max(...out.slice(200).map(Math.abs));
  assert.ok(loudest < 0.01, `${loudest}`);
});

test("the least delayed message sets the clock, and a jump resets it", () => {
  const clock = new SampleClock();
  for (const [contextS, nowMs] of [
    [1, 6_300],
    [1.05, 6_060],
    [1.1, 6_400],
  ]) {
    clock.add(contextS, nowMs);
  }
  assert.equal(Math.round(clock.toPage(1.1)), 6_110);
  clock.add(1.15, 60_000);
  assert.equal(Math.round(clock.toPage(1.15)), 60_000);
});

test("an old quick message is forgotten, so that a clock that drifts is followed", () => {
  const clock = new SampleClock();
  for (let n = 0; n < 100; n += 1) clock.add(n, n * 1_001);
  assert.ok(Math.abs(clock.toPage(99) - 99 * 1_001) < 4);
});

test("a frame has the header that the server reads", () => {
  const samples = Int16Array.of(-2, 513);
  const frame = { stream: 7, takenMs: 1.5, before: 3_200, samples, end: true, held: true };
  const bytes = new Uint8Array(encode(frame));
  assert.deepEqual([...bytes.slice(0, 8)], [1, 3, 0, 0, 7, 0, 0, 0]);
  const view = new DataView(bytes.buffer);
  assert.equal(view.getFloat64(8, true), 1.5);
  assert.equal(view.getBigUint64(16, true), 3_200n);
  assert.deepEqual([...bytes.slice(24)], [254, 255, 1, 2]);
  assert.equal(new Uint8Array(encode({ ...frame, end: false, echoFree: true }))[1], 6);
});

test("the latest sound before a press is kept, and given once", () => {
  const preRoll = new PreRoll(100);
  for (let n = 0; n < 10; n += 1) preRoll.push(new Int16Array(800).fill(n), n * 50);
  const times = preRoll.take().map(({ takenMs }) => takenMs);
  assert.deepEqual(times, [400, 450]);
  assert.deepEqual(preRoll.take(), []);
});

/** A link that keeps what is sent. */
function fakeLink() {
  const frames = [];
  const sendBinary = (buffer) => {
    const view = new DataView(buffer);
    frames.push({
      flags: view.getUint8(1),
      takenMs: view.getFloat64(8, true),
      before: Number(view.getBigUint64(16, true)),
      count: (buffer.byteLength - 24) / 2,
    });
    return true;
  };
  return { frames, backlog: 0, toServer: (ms) => ms + 1_000, sendBinary };
}

test("a stream counts its samples, also those that a slow connection lost", () => {
  const link = fakeLink();
  const stream = new VoiceStream(link, 3);
  assert.ok(stream.send(new Int16Array(2_000), 500, { held: true }));
  link.backlog = 1_000_000;
  assert.ok(!stream.send(new Int16Array(800), 625, {}));
  link.backlog = 0;
  stream.send(new Int16Array(800), 675, {});
  stream.end(725, { held: true });
  stream.end(800, {});
  assert.equal(stream.lost, 800);
  assert.deepEqual(link.frames, [
    { flags: 2, takenMs: 1_500, before: 0, count: 1_600 },
    { flags: 2, takenMs: 1_600, before: 1_600, count: 400 },
    { flags: 0, takenMs: 1_675, before: 2_800, count: 800 },
    { flags: 3, takenMs: 1_725, before: 3_600, count: 0 },
  ]);
});
