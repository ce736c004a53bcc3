// Labels of the arm's picture: where they go, and what a click on the picture means.

import assert from "node:assert/strict";
import { describe, it } from "node:test";
import { apart } from "../../../services/console/page/js/arm/overlay.js";
import { meet, placeLabels } from "../../../services/console/page/js/arm/placement.js";
import { objectAt } from "../../../services/console/page/js/arm/pointing.js";

/** Random numbers from 0 to 1, the same for the same seed. */
function random(seed) {
  let state = seed;
  return () => {
    state = (state * 1_664_525 + 1_013_904_223) % 2 ** 32;
    return state / 2 ** 32;
  };
}

const overlap = (a, b) =>
  Math.min(a.x + a.width, b.x + b.width) - Math.max(a.x, b.x) > 0.01 &&
  Math.min(a.y + a.height, b.y + b.height) - Math.max(a.y, b.y) > 0.01;

/** A scene as the camera may see it: objects on boards, a badge, the buttons. */
function scene(seed) {
  const next = random(seed);
  const between = (low, high) => low + (high - low) * next();
  const frame = { width: between(300, 1400), height: between(200, 900) };
  const count = 1 + Math.floor(next() * 12);
  const side = Math.min(frame.width, frame.height);
  const wishes = Array.from({ length: count }, () => {
    const [width, height] = [between(0.03, 0.12) * side, between(0.02, 0.1) * side];
    const x = between(-20, frame.width - width + 20);
    const y = between(0.2 * frame.height, frame.height - height);
    const label = { width: between(50, 110), height: 18, weight: next() };
    return { box: { x, y, width, height }, ...label };
  });
  const notices = [
    { x: frame.width / 2 - 60, y: 8, width: 120, height: 28 },
    { x: frame.width - 150, y: frame.height - 38, width: 144, height: 32 },
  ];
  return { frame, wishes, notices };
}

const placed = (wishes, places) =>
  wishes.map(({ width, height }, n) => ({ width, height, ...places[n] }));

describe("labels", () => {
  it("beside random scenes: one each, in the picture, off each other, the objects and the notices", () => {
    let crossings = 0;
    for (let seed = 1; seed <= 400; seed++) {
      const { frame, wishes, notices } = scene(seed);
      const labels = placed(wishes, placeLabels(wishes, frame, notices));
      assert.equal(labels.length, wishes.length);
      for (const [n, label] of labels.entries()) {
        const where = `scene ${seed}, label ${n} of ${labels.length}`;
        assert.ok(label.x >= 0 && label.x + label.width <= frame.width, where);
        assert.ok(label.y >= 0 && label.y + label.height <= frame.height, where);
        for (const { box } of wishes) assert.ok(!overlap(label, box), `${where}: an object`);
        for (const notice of notices) assert.ok(!overlap(label, notice), `${where}: a notice`);
        for (const other of labels.slice(n + 1)) assert.ok(!overlap(label, other), where);
        for (const { leader } of labels.slice(n + 1)) {
          if (label.leader && leader && meet(label.leader, leader)) crossings += 1;
        }
      }
    }
    assert.ok(crossings <= 8, `${crossings} leaders cross in 400 scenes`);
  });

  it("leave none out where there is no room at all", () => {
    const box = { x: 40, y: 40, width: 20, height: 20 };
    const crowd = Array.from({ length: 40 }, (_, n) => ({ box, width: 80, height: 20, weight: n }));
    const frame = { width: 100, height: 100 };
    for (const { x, y } of placeLabels(crowd, frame)) {
      assert.ok(x >= 0 && x + 80 <= 100 && y >= 0 && y + 20 <= 100);
    }
    const [wide] = placeLabels([{ box, width: 300, height: 20, weight: 1 }], frame);
    assert.equal(wide.x, 0);
  });

  const frame = { width: 400, height: 300 };
  const wish = (x, y, weight = 1) => ({
    box: { x, y, width: 40, height: 30 },
    width: 80,
    height: 20,
    weight,
  });

  it("stand above their objects, without a leader, where nothing is in the way", () => {
    const [{ x, y, leader }] = placeLabels([wish(180, 150)], frame);
    assert.deepEqual([x, leader], [160, null]);
    assert.ok(y + 20 <= 150 && y + 20 > 140);
  });

  it("have a leader to their object where they had to move", () => {
    const around = { x: 100, y: 100, width: 200, height: 130 };
    const [{ leader }] = placeLabels([wish(180, 150)], frame, [around]);
    assert.ok(leader);
    const [, , x, y] = leader;
    assert.ok(x >= 180 && x <= 220 && y >= 150 && y <= 180, "it ends on the object");
  });

  it("of an object outside the picture stand at the edge where it is", () => {
    const [{ x }] = placeLabels([wish(-300, 100)], frame);
    assert.ok(x < 20);
  });

  it("stay where they were while that is nearly as good", () => {
    const before = placeLabels([wish(180, 150)], frame);
    const kept = placeLabels([wish(181, 149.5)], frame, [], before);
    assert.ok(Math.hypot(kept[0].x - before[0].x, kept[0].y - before[0].y) < 3);
  });
});

describe("the words of a label", () => {
  it("are what tells an object from the others", () => {
    assert.equal(
      apart({ label: "bowl in the dishwasher", name: "white1" }, "bowl"),
      "in the dishwasher",
    );
    assert.equal(apart({ label: "bowl", name: "white1" }, "bowl"), "bowl");
    assert.equal(apart({ name: "white1" }, "bowl"), "white1");
  });
});

describe("a point of the picture", () => {
  const target = (x, y, label = null) => ({ box: { x, y, width: 60, height: 40 }, label });

  it("belongs to the object whose middle is nearest, or to none", () => {
    const targets = [target(100, 100), target(130, 100)];
    assert.equal(objectAt(targets, { x: 135, y: 120 }), 0);
    assert.equal(objectAt(targets, { x: 156, y: 120 }), 1);
    assert.equal(objectAt(targets, { x: 10, y: 10 }), -1);
    assert.equal(objectAt([], { x: 10, y: 10 }), -1);
  });

  it("belongs to the object whose label is there", () => {
    const label = { x: 100, y: 100, width: 60, height: 20 };
    assert.equal(objectAt([target(100, 100), target(300, 300, label)], { x: 130, y: 110 }), 1);
  });

  it("hits what is smaller than a finger", () => {
    const small = { box: { x: 50, y: 50, width: 4, height: 4 }, label: null };
    assert.equal(objectAt([small], { x: 60, y: 52 }), 0);
    assert.equal(objectAt([small], { x: 70, y: 52 }), -1);
  });
});
