// The history: walking through past interactions.

import assert from "node:assert/strict";
import { describe, it } from "node:test";
import {
  KEYS,
  leap,
  NOWHERE,
  placesIn,
  settle,
  shownAt,
  step,
} from "../../../services/console/page/js/history/model.js";

const decided = (belief) => ({
  after_ms: 0,
  heard: [],
  belief,
  absent: 0,
  decision: "ask",
  text: "Is it white?",
});
const end = { outcome: "delivered", object: "cup", questions: 1, seconds: 2 };
const past = (interaction, beliefs, isOver = true) => ({
  interaction,
  unix_ms: 0,
  objects: ["cup", "bowl"],
  steps: beliefs.map(decided),
  end: isOver ? end : null,
});
const HISTORY = [
  past(3, [
    [0.5, 0.5],
    [0.9, 0.1],
  ]),
  past(5, [[0.2, 0.8]], false),
];

describe("the history", () => {
  it("begins with the newest interaction", () => {
    assert.deepEqual(settle(HISTORY, NOWHERE), { interaction: 5, step: 0 });
    assert.deepEqual(settle([], { interaction: 5, step: 2 }), NOWHERE);
  });

  it("is walked step by step, over the ends of interactions, and back", () => {
    const walk = [{ interaction: 3, step: 0 }];
    for (let n = 0; n < 5; n++) walk.push(step(HISTORY, walk.at(-1), 1));
    const places = walk.map((at) => `${at.interaction}.${at.step}`);
    assert.deepEqual(places, ["3.0", "3.1", "3.2", "5.0", "5.0", "5.0"]);
    const back = [walk.at(-1)];
    for (let n = 0; n < 4; n++) back.push(step(HISTORY, back.at(-1), -1));
    assert.deepEqual(
      back.map((at) => `${at.interaction}.${at.step}`),
      ["5.0", "3.2", "3.1", "3.0", "3.0"],
    );
  });

  it("is walked interaction by interaction, and to the ends of one", () => {
    assert.deepEqual(leap(HISTORY, { interaction: 3, step: 2 }, 1), { interaction: 5, step: 0 });
    assert.deepEqual(leap(HISTORY, { interaction: 5, step: 0 }, 1), { interaction: 5, step: 0 });
    assert.deepEqual(KEYS.End(HISTORY, { interaction: 3, step: 0 }), { interaction: 3, step: 2 });
    assert.deepEqual(KEYS.Home(HISTORY, { interaction: 3, step: 2 }), { interaction: 3, step: 0 });
  });

  it("stays where it was while interactions grow and the oldest go", () => {
    const grown = [
      past(5, [
        [0.2, 0.8],
        [0, 1],
      ]),
      past(6, []),
    ];
    assert.deepEqual(settle(grown, { interaction: 5, step: 0 }), { interaction: 5, step: 0 });
    assert.deepEqual(settle(grown, { interaction: 3, step: 1 }), { interaction: 6, step: 0 });
    assert.deepEqual(settle(HISTORY, { interaction: 5, step: 9 }), { interaction: 5, step: 0 });
  });

  it("shows each step with the belief before it, and the end with the last belief", () => {
    assert.equal(placesIn(HISTORY[0]), 3);
    const first = shownAt(HISTORY, { interaction: 3, step: 0 });
    assert.deepEqual([first.step.belief, first.before, first.isEnd], [[0.5, 0.5], null, false]);
    const second = shownAt(HISTORY, { interaction: 3, step: 1 });
    assert.deepEqual(
      [second.step.belief, second.before],
      [
        [0.9, 0.1],
        [0.5, 0.5],
      ],
    );
    const last = shownAt(HISTORY, { interaction: 3, step: 2 });
    assert.deepEqual([last.isEnd, last.step.belief], [true, [0.9, 0.1]]);
    assert.equal(shownAt(HISTORY, NOWHERE), null);
    assert.equal(shownAt([past(7, [], false)], { interaction: 7, step: 0 }).step, null);
  });
});
