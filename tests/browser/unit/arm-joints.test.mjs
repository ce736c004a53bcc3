import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { describe, it } from "node:test";
import {
  fingerPosition,
  JOINT_NAMES,
  JointBuffer,
} from "../../../services/console/page/js/arm/joints.js";

const message = (at_ms, value) => ({
  at_ms,
  q: JOINT_NAMES.map(() => value),
  grip: [100, value],
});

/** Feeds a motion of one unit a second at 30 Hz, each message `late` ms late. */
function moving(buffer, late, seconds = 3) {
  for (let at = 1000; at <= 1000 + seconds * 1000; at += 1000 / 30) {
    buffer.add(message(at, at / 1000), at + late);
  }
  return 1000 + seconds * 1000;
}

describe("the joints' names", () => {
  it("are those of the protocol, in its order", () => {
    const source = readFileSync(
      new URL("../../../shared/messages/src/fixed/arm.rs", import.meta.url),
      "utf8",
    );
    const list = source.match(/JOINT_STATE_NAMES: \[&str; JOINT_STATE_LEN\] = \[([^\]]*)\]/)[1];
    assert.deepEqual(
      JOINT_NAMES,
      [...list.matchAll(/"(\w+)"/g)].map((match) => match[1]),
    );
  });
});

describe("the joint buffer", () => {
  it("has nothing before the first message", () => {
    assert.equal(new JointBuffer().sample(0), null);
  });

  it("shows what lies between two messages, a little behind the clock", () => {
    const buffer = new JointBuffer();
    const end = moving(buffer, 5);
    const sample = buffer.sample(end);
    assert.ok(!sample.settled);
    assert.ok(Math.abs(sample.q[0] - sample.atMs / 1000) < 1e-9, "on the line between both");
    assert.ok(Math.abs(end - buffer.delayMs - sample.atMs) < 1e-9);
    assert.ok(buffer.delayMs >= 33 && buffer.delayMs < 50, `${buffer.delayMs} ms`);
  });

  it("waits longer where messages come late, so that there is always a next one", () => {
    const buffer = new JointBuffer();
    const end = moving(buffer, 90);
    assert.ok(buffer.delayMs > 110 && buffer.delayMs < 140, `${buffer.delayMs} ms`);
    assert.ok(!buffer.sample(end + 80).settled);
  });

  it("never turns a motion back, whatever its delay does", () => {
    const buffer = new JointBuffer();
    let shown = Number.NEGATIVE_INFINITY;
    for (let at = 1000; at < 5000; at += 1000 / 30) {
      const late = at > 2000 ? 150 : 2;
      buffer.add(message(at, at / 1000), at + late);
      const { q } = buffer.sample(at + late);
      assert.ok(q[0] >= shown - 1e-9);
      shown = q[0];
    }
  });

  it("ends on the last message and stays there", () => {
    const buffer = new JointBuffer();
    const end = moving(buffer, 5);
    const sample = buffer.sample(end + 10_000);
    assert.ok(sample.settled);
    assert.ok(Math.abs(sample.atMs - end) < 40);
    assert.deepEqual(sample.grip, buffer.latest.grip);
  });

  it("begins a motion after a pause where it began, not at once", () => {
    const buffer = new JointBuffer();
    buffer.add(message(1000, 0), 1002);
    buffer.add(message(1500, 0), 1502);
    buffer.add(message(2000, 0.02), 2002);
    const before = buffer.sample(2000 - 35 + buffer.delayMs);
    assert.ok(Math.abs(before.q[0]) < 1e-9);
  });

  it("accepts new messages, ignores old ones, and resets with another server", () => {
    const buffer = new JointBuffer();
    assert.equal(buffer.add(message(5000, 1), 5002), true);
    assert.equal(buffer.add(message(5033, 1), 5035), false, "the arm stands");
    assert.equal(buffer.add(message(5010, 9), 5040), false, "older than the last");
    assert.equal(buffer.latest.q[0], 1);
    buffer.add(message(100, 2), 102);
    assert.equal(buffer.sample(1000).q[0], 2);
  });

  it("is bounded", () => {
    const buffer = new JointBuffer();
    moving(buffer, 5, 60);
    assert.ok(buffer.sample(1000).q[0] > 55, "the first ones are forgotten");
  });
});

describe("fingers", () => {
  it("are closed nearest to zero and open farthest from it", () => {
    assert.equal(fingerPosition({ lower: 0, upper: 0.02 }, 0), 0);
    assert.equal(fingerPosition({ lower: 0, upper: 0.02 }, 100), 0.02);
    assert.equal(fingerPosition({ lower: -0.02, upper: 0 }, 100), -0.02);
    assert.equal(fingerPosition({ lower: -0.02, upper: 0 }, 250), -0.02);
  });
});
