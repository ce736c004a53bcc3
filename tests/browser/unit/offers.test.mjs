import assert from "node:assert/strict";
import { describe, it } from "node:test";
import { deliveryOf, keepDelivery } from "../../../services/console/page/js/delivery.js";
import { answers, offers } from "../../../services/console/page/js/model/answers.js";
import { Store } from "../../../services/console/page/js/store.js";

const PLACES = [
  { name: "sink", spoken: "by the sink" },
  { name: "shelf", spoken: "on the shelf" },
  { name: "table", spoken: "on the table" },
];
const SCENE = {
  attributes: [
    { name: "place", values: PLACES },
    { name: "size", values: ["big", "small"].map((name) => ({ name, spoken: name })) },
  ],
  objects: [
    { name: "a", label: "cup by the sink", attributes: { place: "sink", size: "big" } },
    { name: "b", label: "cup on the shelf", attributes: { place: "shelf", size: "small" } },
    { name: "c", label: "cup on the table", attributes: { place: "table", size: "small" } },
  ],
  examples: ["get me the cup", "the big cup"],
};
const ASIDES = ["I don't know", "it doesn't matter"];
const texts = (all) => all.map(({ text }) => text);

describe("answers with one press", () => {
  const of = (question, more = {}) => texts(answers({ decision: "ask", question, ...more }, SCENE));

  it("are yes and no, and the other values where there are several", () => {
    const place = { type: "attr", attribute: "place", value: "shelf" };
    assert.deepEqual(of(place), ["yes", "no", ...ASIDES, "by the sink", "on the table"]);
    const size = { type: "attr", attribute: "size", value: "big" };
    assert.deepEqual(of(size), ["yes", "no", ...ASIDES]);
    assert.deepEqual(of({ type: "point", object: "a" }), ["yes", "no", ...ASIDES]);
  });

  it("are the values of an open question that are still possible", () => {
    const which = { type: "which", attribute: "place" };
    assert.deepEqual(of(which), [...PLACES.map(({ spoken }) => spoken), ...ASIDES]);
    const belief = { a: 0.6, b: 0.4, c: 0 };
    assert.deepEqual(of(which, { belief }), ["by the sink", "on the shelf", ...ASIDES]);
    assert.deepEqual(of({ type: "which", attribute: "gone" }), ASIDES);
  });

  it("are yes and no for a pick that waits for a yes, and none without a question", () => {
    assert.deepEqual(of({ type: "point", object: "a" }, { decision: "say" }), ["yes", "no"]);
    assert.deepEqual(of({ type: "attr" }, { decision: "pick" }), []);
    assert.deepEqual(of(null), []);
    assert.deepEqual(of({ type: "none" }), []);
    assert.deepEqual(answers(undefined, SCENE), []);
  });
});

describe("what is offered", () => {
  const idle = { interaction: 0, decision: "say", question: { type: "none" } };

  it("are examples where nothing is asked for", () => {
    assert.deepEqual(texts(offers(idle, SCENE, null)), SCENE.examples);
    assert.deepEqual(offers({ ...idle, interaction: 3 }, SCENE, null), []);
    assert.deepEqual(offers(undefined, undefined, null), []);
  });

  it("are three things to say of what was handed over", () => {
    const of = texts(offers(idle, SCENE, { interaction: 1 }));
    assert.deepEqual(of, ["yes, that's right", "no, that's the wrong one", "put it back"]);
  });

  it("are the answers where a question stands", () => {
    const question = { type: "point", object: "a" };
    assert.deepEqual(texts(offers({ ...idle, question }, SCENE, null)), ["yes", "no"]);
  });
});

describe("what was handed over", () => {
  const refusable = { interaction: 4, object: "b", until_ms: 10_000 };
  const dialogue = { interaction: 0, refusable };

  it("counts until the time for a refusal is over", () => {
    assert.deepEqual(deliveryOf(dialogue, SCENE, 4_000, undefined), {
      interaction: 4,
      object: SCENE.objects[1],
      leftMs: 6_000,
    });
    assert.equal(deliveryOf(dialogue, SCENE, 10_000, undefined), null);
  });

  it("ends with a new request, with a confirmation, and with the scene", () => {
    assert.equal(deliveryOf({ ...dialogue, interaction: 5 }, SCENE, 0, undefined), null);
    assert.equal(deliveryOf({ interaction: 0, refusable: null }, SCENE, 0, undefined), null);
    assert.equal(deliveryOf(dialogue, SCENE, 0, 4), null);
    assert.ok(deliveryOf(dialogue, SCENE, 0, 3));
    assert.equal(deliveryOf(dialogue, { objects: [] }, 0, undefined), null);
    assert.equal(deliveryOf(undefined, undefined, 0, undefined), null);
  });

  it("goes away by itself", (test) => {
    test.mock.timers.enable({ apis: ["setTimeout"] });
    const store = new Store();
    let now = 0;
    keepDelivery({ link: { serverNow: () => now }, store });
    store.apply({ dialogue: { interaction: 4, belief: { b: 0.9 } }, scene: SCENE });
    store.apply({ dialogue: { ...dialogue, belief: { b: 0.3 } } });
    assert.equal(store.get("delivery").object.name, "b");
    assert.deepEqual(store.get("belief"), { b: 0.9 }, "what was believed still stands");
    now = 10_000;
    test.mock.timers.tick(10_000);
    assert.equal(store.get("delivery"), null);
    assert.deepEqual(store.get("belief"), { b: 0.3 });
  });
});
