import assert from "node:assert/strict";
import { describe, it } from "node:test";
import { LINES_MAX, mergeLines } from "../../../services/console/page/js/model/lines.js";
import { keep, Store } from "../../../services/console/page/js/store.js";

const lines = (...ids) => ids.map((id) => ({ id, text: `line ${id}` }));
const ids = (list) => list.map((line) => line.id);

describe("the transcript", () => {
  it("appends, replaces and sorts by id", () => {
    const known = mergeLines([], lines(1, 2, 3));
    assert.deepEqual(ids(mergeLines(known, lines(4, 5))), [1, 2, 3, 4, 5]);
    const again = mergeLines(known, [{ id: 2, text: "understood" }]);
    assert.deepEqual(ids(again), [1, 2, 3]);
    assert.equal(again[1].text, "understood");
    assert.equal(again[0], known[0], "what has not changed stays the same object");
    assert.deepEqual(ids(mergeLines(known, lines(9, 5))), [1, 2, 3, 5, 9]);
    assert.equal(mergeLines(known, []), known);
  });

  it("gives way to another one that counts from 1 again", () => {
    const timed = (...pairs) => pairs.map(([id, at_ms]) => ({ id, at_ms }));
    const known = timed([7, 100], [8, 90], [9, 120]);
    assert.deepEqual(ids(mergeLines(known, timed([8, 90], [10, 130]))), [7, 8, 9, 10]);
    assert.deepEqual(ids(mergeLines(known, timed([1, 500]))), [1], "an early number, but later");
    assert.deepEqual(ids(mergeLines(known, timed([8, 500], [9, 510]))), [8, 9], "other lines");
    assert.deepEqual(ids(mergeLines(known, timed([6, 80]))), [6, 7, 8, 9], "one from before");
  });

  it("keeps the latest, and no more than the server", () => {
    const many = Array.from({ length: 500 }, (_, i) => ({ id: i + 1 }));
    const kept = mergeLines([], many);
    assert.equal(kept.length, LINES_MAX);
    assert.equal(kept.at(-1).id, 500);
    assert.equal(mergeLines(kept, [{ id: 1 }]).length, LINES_MAX);
  });
});

describe("the store", () => {
  it("notifies subscribers at once and on each change, until they unsubscribe", () => {
    const store = new Store();
    store.set("turn", 1);
    const heard = [];
    const leave = store.subscribe(["turn", "arm"], (value, section) =>
      heard.push([section, value]),
    );
    store.apply({ arm: 2, scene: 3 });
    leave();
    store.set("turn", 4);
    assert.deepEqual(heard, [
      ["turn", 1],
      ["arm", 2],
    ]);
    assert.equal(store.get("scene"), 3);
    assert.equal(store.get("nothing"), undefined);
  });

  it("publishes only complete frames", () => {
    const store = new Store();
    store.apply({ scene: "old", dialogue: "old" });
    const seen = [];
    store.subscribe("scene", () => seen.push([store.get("scene"), store.get("dialogue")]));
    store.apply({ scene: "new", dialogue: "new" });
    assert.deepEqual(seen.at(-1), ["new", "new"]);
  });

  it("repeats the last lines after a lost connection", () => {
    const store = new Store();
    assert.equal(store.resumeAfter, 0);
    store.addLines(Array.from({ length: 40 }, (_, i) => ({ id: i + 1 })));
    assert.equal(store.resumeAfter, 30);
  });

  it("resets the transcript with a server that has another one", () => {
    const store = new Store();
    store.addLines(lines(1, 2, 3));
    store.resume(1);
    assert.equal(store.lastLine, 3, "the same transcript continues");
    store.resume(undefined);
    assert.equal(store.lastLine, 3);
    store.resume(0);
    assert.equal(store.lastLine, 0, "a new group has no lines yet");
    store.addLines(lines(4));
    store.resume(90);
    assert.equal(store.lastLine, 0, "lines between were missed: all of them come again");
  });
});

describe("a large scene", () => {
  it("is put together from the objects with a place and those of the moment", () => {
    const store = new Store();
    const listeners = new Map();
    keep(store, { status: {}, on: (what, f) => listeners.set(what, f) });
    const receive = (parts) => listeners.get("state")(parts);
    const names = () => store.get("scene").objects.map(({ name }) => name);
    receive({ scene: { key: "a", objects: [{ name: "near" }] }, further: [{ name: "far" }] });
    assert.deepEqual(names(), ["near", "far"]);
    receive({ further: [{ name: "other" }] });
    assert.deepEqual(names(), ["near", "other"]);
    receive({ scene: { key: "b", objects: [{ name: "new" }] }, further: [] });
    assert.deepEqual(names(), ["new"]);
    receive({ turn: 1 });
    assert.deepEqual(
      store.get("scene").standing.map(({ name }) => name),
      ["new"],
    );
  });
});
