import assert from "node:assert/strict";
import { describe, it } from "node:test";
import { HOLD_MS, Hold, QUIET_MS } from "../../../services/console/page/js/model/hold.js";

/** Steps a hold every 20 ms from one time to another; returns how often it was complete. */
function steps(hold, from, to) {
  let completed = 0;
  for (let now = from; now <= to; now += 20) completed += hold.step(now) ? 1 : 0;
  return completed;
}

describe("a held control", () => {
  it("is complete after a second, once", () => {
    const hold = new Hold();
    assert.equal(hold.begin(0), true);
    assert.equal(steps(hold, 0, HOLD_MS - 20), 0);
    assert.ok(hold.share > 0.9 && hold.share < 1);
    assert.equal(steps(hold, HOLD_MS, 5 * HOLD_MS), 1);
    assert.equal(hold.share, null);
  });

  it("is not complete if it is released before, however often", () => {
    const hold = new Hold();
    for (let at = 0; at < 60_000; at += HOLD_MS) {
      assert.equal(hold.begin(at), true);
      assert.equal(steps(hold, at, at + HOLD_MS - 20), 0);
      hold.end();
    }
  });

  it("neither begins nor counts near a press, and each press prolongs that", () => {
    const hold = new Hold();
    hold.begin(0);
    hold.press(900);
    assert.equal(steps(hold, 900, 5_000), 0, "a running hold is cancelled");
    hold.press(10_000);
    hold.press(11_500);
    assert.equal(hold.begin(12_000), false);
    assert.equal(hold.begin(11_500 + QUIET_MS - 1), false);
    assert.equal(steps(hold, 12_000, 20_000), 0, "a hold that has not begun never counts");
    assert.equal(hold.begin(20_000), true);
  });

  it("takes Space for a press, also where Space holds", () => {
    const hold = new Hold();
    assert.equal(hold.begin(0, true), true);
    assert.equal(steps(hold, 0, HOLD_MS), 1);
    assert.equal(hold.begin(1_500, true), false);
    assert.equal(hold.begin(3_400), false, "it was prolonged");
    assert.equal(hold.begin(3_500), true);
  });

  it("is not begun twice by two fingers", () => {
    const hold = new Hold();
    assert.deepEqual([hold.begin(0), hold.begin(10)], [true, false]);
  });

  it("waits for a page that is busy: a release may come late", () => {
    const hold = new Hold();
    hold.begin(0);
    assert.equal(hold.step(30_000), false);
    hold.end();
    assert.equal(hold.step(30_050), false);
  });

  it("is never completed by presses, whatever their rhythm", () => {
    for (let every = 10; every <= 3_000; every += 10) {
      const hold = new Hold();
      let completed = 0;
      for (let at = 0; at < 30_000; at += every) {
        // Space on Resume itself is the worst: it holds as long as the rhythm lets it.
        const down = Math.min(0.5 * every, HOLD_MS - 20);
        hold.begin(at, true);
        completed += steps(hold, at, at + down);
        hold.end();
      }
      assert.equal(completed, 0, `every ${every} ms`);
    }
  });
});
