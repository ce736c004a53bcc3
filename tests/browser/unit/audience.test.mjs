// The page for an audience, and the camera's picture.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { describe, it } from "node:test";
import { addressOf, Feed } from "../../../services/console/page/js/arm/feed.js";
import { lastHeard, sentence, sizeOf } from "../../../services/console/page/js/audience/model.js";
import { translator } from "../../../services/console/page/js/strings.js";

const english = JSON.parse(
  readFileSync(new URL("../../../services/console/page/strings/en.json", import.meta.url), "utf8"),
);
const t = translator("en", [english]);

describe("the audience's sentence", () => {
  const scene = { noun: "bowl", objects: [{ name: "white2", label: "white bowl" }] };
  const up = { now: { is: "asking", turn: "asked", why: null }, scene, delivery: null };
  const asks = { interaction: 4, text: "Is it on the counter?", last: null };
  const rests = { interaction: 0, text: "", last: { outcome: "cancelled", object: null } };

  it("is the robot's question or announcement", () => {
    assert.equal(sentence({ ...up, dialogue: asks }, t), "Is it on the counter?");
  });

  it("is what was handed over, while it can be refused, else an invitation", () => {
    const delivery = { object: scene.objects[0] };
    const handed = sentence({ ...up, dialogue: rests, delivery }, t);
    assert.equal(handed, "Handed over: white bowl");
    assert.equal(sentence({ ...up, dialogue: rests }, t), t("question.idle", { noun: "bowl" }));
  });

  it("is what is the matter, where something is", () => {
    const stopped = { ...up, now: { is: "stopped", atRest: true, why: null }, dialogue: asks };
    assert.equal(sentence(stopped, t), t("turn.stopped"));
    const offline = { ...up, now: { is: "disconnected", why: "offline" }, dialogue: asks };
    assert.equal(sentence(offline, t), t("turn.offline"));
    assert.equal(sentence({ ...up, dialogue: undefined }, t), t("question.none"));
  });

  it("is at least a twentieth of the height, however long", () => {
    const sizes = [1, 30, 80, 150, 400].map((n) => sizeOf("x".repeat(n)));
    assert.ok(sizes.every((size, n) => size >= 5 && (n === 0 || size <= sizes[n - 1])));
  });

  it("is followed by what was meant for the robot", () => {
    const lines = [
      { who: "person", text: "the bowl" },
      { who: "unmeant", text: "nice weather" },
    ];
    assert.equal(lastHeard(lines), "the bowl");
    assert.equal(lastHeard(undefined), "");
  });
});

describe("the camera's picture", () => {
  /** An image, a clock and a feed between them. */
  function make(every_ms) {
    const image = Object.assign(new EventTarget(), {
      src: "",
      removeAttribute() {
        this.src = "";
      },
    });
    const waiting = new Map();
    const clock = {
      at: 1,
      now() {
        return this.at++;
      },
      setTimeout(f, ms) {
        waiting.set(f, ms);
        return f;
      },
      clearTimeout: (f) => waiting.delete(f),
    };
    const states = [];
    const camera = { url: "http://cam:8080/now.jpg?size=2", every_ms };
    const feed = new Feed(image, camera, (state) => states.push(state), clock);
    const run = () => {
      const [[f, ms]] = waiting;
      waiting.delete(f);
      f();
      return ms;
    };
    const happens = (type) => image.dispatchEvent(new Event(type));
    return { feed, image, states, waiting, run, happens };
  }

  it("is fetched again and again where there are single pictures", () => {
    const { feed, image, states, run, happens } = make(500);
    feed.start();
    const first = image.src;
    assert.ok(first.startsWith("http://cam:8080/now.jpg?size=2&at="));
    happens("load");
    assert.equal(run(), 500);
    assert.notEqual(image.src, first, "no cache has it");
    assert.deepEqual(states, ["waiting", "shown"]);
  });

  it("is fetched once where it is a stream", () => {
    const { feed, waiting, happens } = make(null);
    feed.start();
    happens("load");
    assert.equal(waiting.size, 0);
  });

  it("is tried again after a failure, and not at all once nobody looks", () => {
    const { feed, image, states, waiting, run, happens } = make(null);
    feed.start();
    happens("error");
    assert.equal(states.at(-1), "failed");
    assert.ok(run() > 0);
    happens("error");
    feed.stop();
    assert.deepEqual([waiting.size, image.src], [0, ""]);
    happens("error");
    assert.equal(waiting.size, 0, "the end of a stream is no failure");
  });

  it("keeps the address as it is otherwise", () => {
    assert.equal(addressOf("http://cam/a?b=c", 7), "http://cam/a?b=c&at=7");
  });
});
