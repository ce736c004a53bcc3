import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { describe, it } from "node:test";
import {
  boardsUnder,
  personsPlaces,
  tableTop,
} from "../../../services/console/page/js/arm/boards.js";
import {
  boundsOf,
  FIELD_DEG,
  VIEWS,
  viewOf,
} from "../../../services/console/page/js/arm/cameras.js";
import { Fineness, Rolling } from "../../../services/console/page/js/arm/figures.js";
import { limbNames } from "../../../services/console/page/js/arm/joints.js";
import { lookOf, partsOf } from "../../../services/console/page/js/arm/looks.js";
import { armWords, indexOf, thoughtsOf } from "../../../services/console/page/js/arm/words.js";
import { translator } from "../../../services/console/page/js/strings.js";

const place = (x, y, z, size = [0.1, 0.1, 0.06]) => ({ xyz: [x, y, z], size, yaw: 0 });

describe("boards", () => {
  it("shares a board among what stands close and equally high", () => {
    const found = boardsUnder([place(0.6, 0, 0), place(0.6, 0.9, 0), place(0.7, 0.2, 0.005)]);
    assert.equal(found.length, 2);
    assert.ok(Math.abs(found[0].high[1] - 0.3) < 1e-12 && Math.abs(found[0].top + 0.03) < 1e-12);
    assert.equal(boardsUnder([place(0.6, 0, 0), place(0.6, 0.1, 0.2)]).length, 2);
    assert.deepEqual(boardsUnder([]), []);
  });

  it("grows boards together until none come close", () => {
    const row = [0, 0.8, 0.4].map((y) => place(0.6, y, 0));
    assert.equal(boardsUnder(row).length, 1);
  });

  it("puts what was handed over beside each other on the person's side, on the table", () => {
    const places = [place(0.6, 0, 0), place(0.7, 0.3, 0.3), place(0.65, -0.4, 0)];
    const taken = personsPlaces(places, [0, 2]);
    const [a, b] = [taken.get(0), taken.get(2)];
    assert.ok(a[0] > 1 && b[0] === a[0]);
    assert.ok(Math.abs(b[1] - a[1]) >= 0.1, "they do not touch");
    assert.ok(Math.abs(a[2] - 0.03 - tableTop(places)) < 1e-12);
    assert.equal(personsPlaces(places, []).size, 0);
  });
});

describe("cameras", () => {
  const box = { low: [-0.2, -1, -0.4], high: [0.9, 1, 0.9] };

  for (const name of VIEWS) {
    for (const aspect of [0.5, 1, 2.2]) {
      it(`${name} has everything in a picture of shape ${aspect}, and fills it`, () => {
        const { eye, target } = viewOf(name, box, aspect);
        const seen = projected(eye, target, aspect, box);
        const most = Math.max(...seen.flat().map(Math.abs));
        assert.ok(most <= 1.001, `${most} is outside`);
        assert.ok(most > 0.97, `${most} leaves room`);
      });
    }
  }

  it("takes objects in, and leaves the foot of the robot out", () => {
    const { low, high } = boundsOf([place(1.2, 0, 0)], {
      low: [-0.5, -1, -0.95],
      high: [0.5, 1, 0.8],
    });
    assert.ok(high[0] >= 1.25 && low[2] > -0.5);
  });
});

/** Where the corners of a box are in the picture, -1 to 1. */
function projected(eye, target, aspect, { low, high }) {
  const sub = (a, b) => a.map((value, k) => value - b[k]);
  const dot = (a, b) => a.reduce((sum, value, k) => sum + value * b[k], 0);
  const cross = (a, b) =>
    [0, 1, 2].map((k) => a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3]);
  const unit = (a) => a.map((value) => value / Math.hypot(...a));
  const ahead = unit(sub(target, eye));
  const right = unit(cross(ahead, [0, 0, 1]));
  const up = cross(right, ahead);
  const slope = Math.tan((FIELD_DEG * Math.PI) / 360);
  return Array.from({ length: 8 }, (_, n) => {
    const way = sub(
      [0, 1, 2].map((k) => ((n >> k) & 1 ? high[k] : low[k])),
      eye,
    );
    const far = dot(way, ahead);
    return [dot(way, right) / (far * slope * aspect), dot(way, up) / (far * slope)];
  });
}

describe("looks", () => {
  const look = (attributes, noun = "bowl", size = [0.12, 0.12, 0.05]) =>
    lookOf({ name: "x", attributes, size }, noun);

  it("knows clear and metallic things, and their colours", () => {
    assert.equal(look({ color: "clear" }).finish, "clear");
    assert.equal(look({ color: "metallic", material: "metal" }).finish, "metal");
    const white = look({ color: "white", material: "plastic" });
    assert.equal(white.finish, "plain");
    assert.notEqual(white.colour, look({ color: "red" }).colour);
  });

  it("takes the form from a word, or else from the size", () => {
    assert.equal(look({}).form, "bowl");
    assert.equal(look({ kind: "screwdriver" }, "tool").form, "screwdriver");
    assert.equal(look({ shape: "round" }, "thing").form, "bowl");
    assert.equal(look({ shape: "round" }, "thing", [0.06, 0.06, 0.12]).form, "can");
    assert.equal(look({}, "thing", [0.2, 0.02, 0.02]).form, "rod");
    assert.equal(look({}, "thing", [0.1, 0.08, 0.06]).form, "box");
  });

  const forms = "bowl plate cup bottle can ball box rod marker pen screwdriver wrench".split(" ");
  for (const form of forms) {
    it(`draws a ${form} within its size`, () => {
      const size = form === "bowl" || form === "plate" ? [0.12, 0.12, 0.05] : [0.2, 0.03, 0.02];
      const parts = partsOf(form, size);
      assert.ok(parts.length > 0);
      for (const { body, profile, along, at } of parts.filter((part) => part.body === "lathe")) {
        assert.equal(body, "lathe");
        const half = size["xyz".indexOf(along)] / 2;
        assert.ok(
          profile.every(([r, z]) => r >= -1e-9 && Math.abs(z + at[2]) <= half * 1.05),
          form,
        );
        const across = Math.max(...size) / 2;
        assert.ok(
          profile.every(([r]) => r <= across + 1e-9),
          form,
        );
      }
    });
  }

  it("has a form for every object of the shipped scenes", () => {
    for (const scene of ["bowls", "markers", "tools"]) {
      const text = readFileSync(
        new URL(`../../../config/scenes/${scene}.toml`, import.meta.url),
        "utf8",
      );
      assert.match(text, /noun = "\w+"/);
      const noun = text.match(/noun = "(\w+)"/)[1];
      const kinds = [...text.matchAll(/kind = "(\w+)"/g)].map((match) => match[1]);
      for (const kind of kinds.length ? kinds : [noun]) {
        const { form } = look({ kind }, noun, [0.2, 0.02, 0.02]);
        assert.ok(forms.includes(form) && !["box", "rod"].includes(form), `${scene}: ${kind}`);
      }
    }
  });
});

describe("limbs of a description", () => {
  const robot = (...links) => ({ links: Object.fromEntries(links.map((link) => [link, {}])) });

  it("are both, or the only one under its own name", () => {
    assert.deepEqual(limbNames(robot("left_gripper", "right_gripper", "l_gripper_l_finger")), [
      "left",
      "right",
    ]);
    const text = readFileSync(new URL("../../../config/robots/ur5e.urdf", import.meta.url), "utf8");
    const links = [...text.matchAll(/<link name="(\w+)"/g)].map((match) => match[1]);
    assert.deepEqual(limbNames(robot(...links)), ["arm"]);
    assert.deepEqual(limbNames(robot("world")), []);
  });
});

describe("words and thoughts", () => {
  const scene = {
    objects: [
      { name: "a", label: "small white bowl", attributes: { color: "white" } },
      { name: "b", label: "big clear bowl", attributes: { color: "clear" } },
    ],
  };
  const table = (code) =>
    JSON.parse(
      readFileSync(new URL(`../../../services/console/page/strings/${code}.json`, import.meta.url)),
    );

  for (const code of ["en", "de"]) {
    it(`says everything that the arm can be in (${code})`, () => {
      const t = translator(code, [table(code)]);
      const idle = {
        phase: "idle",
        outcome: "pending",
        object: null,
        moving: false,
        stopped: false,
      };
      const states = [
        null,
        idle,
        { ...idle, stopped: true },
        { ...idle, aimed: true },
        { ...idle, moving: true },
      ];
      for (const phase of ["accepted", "moving", "closing", "holding"]) {
        states.push(
          { ...idle, phase, object: "a", remaining_s: 4.2 },
          { ...idle, phase, object: "a" },
          { ...idle, task: "put_back", phase, object: "a" },
        );
      }
      for (const outcome of [
        "delivered",
        "unreachable",
        "interrupted",
        "cancelled",
        "missed",
        "blocked",
        "put_back",
        "vanished",
        "kept",
      ]) {
        states.push({ ...idle, phase: "done", outcome, object: "b" });
        states.push({ ...idle, task: "put_back", phase: "done", outcome, object: "b" });
      }
      for (const hindrance of [
        "stopped",
        "error",
        "disabled",
        "unheard",
        "stale",
        "gripper",
        "calibrating",
      ]) {
        states.push({ ...idle, hindrance });
      }
      const said = states.map((arm) => armWords({ why: null, order: arm }, arm, scene, null, t));
      assert.ok(
        said.every((words) => words && !words.includes("arm.") && !words.includes("{")),
        said.join("|"),
      );
      const moves = { ...idle, phase: "moving", object: "a", remaining_s: 4.2 };
      const way = armWords({ why: null, order: moves }, moves, scene, null, t);
      assert.ok(way.includes("small white bowl") && way.includes("4"), way);
    });
  }

  it("finds objects by name and by place", () => {
    assert.equal(indexOf("b", scene), 1);
    assert.equal(indexOf(1, scene), 1);
    assert.equal(indexOf(7, scene), null);
    assert.equal(indexOf(null, scene), null);
    assert.equal(indexOf("a", undefined), null);
  });

  it("marks the likeliest object and those that are asked about", () => {
    const belief = { a: 0.8, b: 0.2 };
    const color = { type: "attr", attribute: "color", value: "clear" };
    const [a, b] = thoughtsOf(belief, color, scene);
    assert.deepEqual([a.best, a.asked, b.best, b.asked], [true, false, false, true]);
    const pointed = thoughtsOf(belief, { type: "point", object: "a" }, scene);
    assert.deepEqual(
      pointed.map(({ asked }) => asked),
      [true, false],
    );
  });

  it("marks none while all are equally likely, or nothing is asked", () => {
    const even = thoughtsOf({ a: 0.5, b: 0.5 }, null, scene);
    assert.ok(even.every(({ best, asked }) => !best && !asked));
    assert.deepEqual(thoughtsOf(undefined, null, undefined), []);
  });
});

describe("figures", () => {
  it("give quantiles of the latest values", () => {
    const rolling = new Rolling();
    assert.deepEqual(rolling.spread, { p50: null, p99: null });
    for (let n = 1; n <= 101; n++) rolling.add(n);
    assert.deepEqual([rolling.spread.p50, rolling.spread.p99, rolling.count], [51, 100, 101]);
    for (let n = 0; n < 600; n++) rolling.add(7);
    assert.equal(rolling.spread.p99, 7, "the oldest are forgotten");
    rolling.clear();
    assert.equal(rolling.count, 0);
  });

  it("draw coarser at once when frames crawl, and finer again with patience", () => {
    const fineness = new Fineness(4, 0);
    const run = (interval, frames) => {
      for (let n = 0; n < frames; n++) fineness.add(interval);
    };
    run(16.7, 200);
    assert.equal(fineness.level, 0);
    run(80, 8);
    assert.equal(fineness.level, 2);
    run(25, 20);
    assert.equal(fineness.level, 3);
    run(25, 200);
    assert.equal(fineness.level, 3, "there is nothing coarser");
    run(16.7, 12 * 20);
    assert.equal(fineness.level, 3);
    run(16.7, 20);
    assert.equal(fineness.level, 2);
  });
});
