import assert from "node:assert/strict";
import { describe, it } from "node:test";
import { Refused } from "../../../services/console/page/js/scene/api.js";
import {
  about,
  addObject,
  freeName,
  freeSpot,
  moveBy,
  proposedPlace,
  removeAttribute,
  removeValue,
  renameAttribute,
  renameValue,
  resize,
  setPlaced,
  setValue,
  toLines,
  toWords,
  turnTo,
} from "../../../services/console/page/js/scene/document.js";
import { Draft } from "../../../services/console/page/js/scene/draft.js";
import { clearance, corners, nearest } from "../../../services/console/page/js/scene/geometry.js";
import { ReachMap, reachKey } from "../../../services/console/page/js/scene/reach.js";
import { SceneSession } from "../../../services/console/page/js/scene/session.js";

const thing = (name, x, y, more = {}) => ({
  from: null,
  name,
  attributes: { color: "red" },
  xyz: [x, y, -0.13],
  size: [0.1, 0.04, 0.05],
  grasp_width: 0.04,
  yaw: null,
  ...more,
});
const scene = (...objects) => ({
  name: "s",
  noun: "box",
  attributes: [
    { from: 0, name: "color", synonyms: [], values: [{ name: "red" }, { name: "blue" }] },
    { from: 1, name: "size", synonyms: [], values: [{ name: "big" }] },
  ],
  objects,
});
const near = (a, b) => assert.ok(Math.abs(a - b) < 1e-9, `${a} is not ${b}`);

describe("the clearance of two objects", () => {
  it("is between their nearest edges, whichever way they are turned", () => {
    const [a, b] = [thing("a", 0.6, 0), thing("b", 0.6, 0.1)];
    near(clearance(a, b).gap, 0.06);
    near(clearance(a, { ...b, yaw: Math.PI / 2 }).gap, 0.03);
    near(clearance({ ...a, xyz: [0.4, 0, -0.13] }, b).gap, Math.hypot(0.1, 0.06));
    const turned = corners(thing("c", 0, 0, { yaw: Math.PI / 2 }));
    near(turned[0][0], -0.02);
    near(turned[0][1], 0.05);
  });

  it("is 0 where they overlap, and none where one is above the other", () => {
    const a = thing("a", 0.6, 0);
    assert.equal(clearance(a, thing("b", 0.62, 0.01)).gap, 0);
    assert.equal(clearance(a, thing("b", 0.6, 0, { yaw: 0.7 })).gap, 0);
    assert.equal(clearance(a, thing("b", 0.6, 0, { xyz: [0.6, 0, 0.2] })), null);
  });

  it("is to the nearest of all", () => {
    const objects = [
      thing("a", 0.6, 0),
      thing("b", 0.6, 0.5),
      thing("c", 0.6, -0.2),
      { name: "d" },
    ];
    assert.equal(nearest(objects, 0).other, 2);
    assert.equal(nearest(objects, 3), null);
    assert.equal(nearest([objects[0]], 0), null);
  });
});

describe("a scene document", () => {
  it("takes another object like one, where there is room", () => {
    const document = scene(thing("cup", 0.6, 0));
    const spot = (size, z) =>
      freeSpot(document.objects, size, z, { middle: [0.6, 0], reaches: (_, y) => y >= 0 });
    const n = addObject(document, 0, { spot, table_z_m: -0.155 });
    assert.equal(n, 1);
    assert.deepEqual(document.objects[1].attributes, { color: "red" });
    assert.equal(document.objects[1].name, "cup_2");
    assert.ok(clearance(document.objects[0], document.objects[1]).gap >= 0.08 - 1e-9);
    assert.ok(document.objects[1].xyz[1] >= 0);
    const empty = scene();
    addObject(empty, null, { spot: () => [0.6, 0], table_z_m: -0.155 });
    assert.equal(empty.objects[0].xyz[2], -0.13);
  });

  it("gives names that are free", () => {
    assert.equal(freeName([{ name: "a" }], "b"), "b");
    assert.equal(freeName([{ name: "a" }, { name: "a_2" }], "a_2"), "a_3");
  });

  it("moves to millimetres, turns to half a turn, and stands where it stood when its size changes", () => {
    const object = thing("a", 0.6, 0);
    moveBy(object, 0.0104, -0.01);
    assert.deepEqual(object.xyz, [0.61, -0.01, -0.13]);
    turnTo(object, 0);
    assert.equal(object.yaw, null);
    turnTo(object, (3 * Math.PI) / 2);
    near(object.yaw, -1.5708);
    resize(object, [0.1, 0.1, 0.1]);
    near(object.xyz[2], -0.105);
    setPlaced(object, null);
    assert.equal(reachKey(object), "");
    setPlaced(object, [0.5, 0, 0]);
    assert.deepEqual([object.xyz, object.grasp_width], [[0.5, 0, 0], 0.03]);
  });

  it("keeps the objects' values when attributes and values are renamed or removed", () => {
    const document = scene(thing("a", 0.6, 0), thing("b", 0.6, 0.3));
    setValue(document.objects[0], "size", "big");
    renameAttribute(document, 0, "colour");
    renameValue(document, 0, 0, "crimson");
    assert.deepEqual(document.objects[0].attributes, { colour: "crimson", size: "big" });
    removeValue(document, 1, 0);
    assert.deepEqual(document.objects[0].attributes, { colour: "crimson" });
    removeAttribute(document, 0);
    assert.deepEqual(document.objects[1].attributes, {});
    setValue(document.objects[1], "size", "");
    assert.deepEqual(document.objects[1].attributes, {});
  });

  it("reads words and lines as people write them", () => {
    assert.deepEqual(toWords(" navy,, dark blue ,"), ["navy", "dark blue"]);
    assert.deepEqual(toLines("Is it {value}?\n\n  Really?\n"), ["Is it {value}?", "Really?"]);
  });

  it("knows what a problem is about, and where it is proposed to move", () => {
    assert.deepEqual(about({ key: "objects[3].xyz" }), { kind: "object", n: 3 });
    assert.deepEqual(about({ key: "attributes[1].values[0]" }), { kind: "attribute", n: 1 });
    assert.deepEqual(about({ key: "noun" }), { kind: "scene", n: -1 });
    const cure = "move it 800 mm back: xyz = [0.85, 0.2, -0.105]";
    assert.deepEqual(proposedPlace({ cure }), [0.85, 0.2, -0.105]);
    assert.equal(proposedPlace({ cure: "leave it out" }), null);
  });
});

describe("a draft", () => {
  const opened = () => ({ name: "s", text: "", hash: "h", document: scene(thing("a", 0.6, 0)) });

  it("undoes a whole movement at once, and redoes it", () => {
    const draft = new Draft(opened());
    for (const x of [0.61, 0.62]) {
      draft.change(({ objects }) => objects[0].xyz.splice(0, 1, x), "move 0");
    }
    draft.settle();
    draft.change(({ objects }) => objects[0].xyz.splice(0, 1, 0.7), "move 0");
    assert.ok(draft.isChanged);
    draft.undo();
    assert.equal(draft.document.objects[0].xyz[0], 0.62);
    draft.undo();
    assert.equal(draft.document.objects[0].xyz[0], 0.6);
    assert.ok(!draft.isChanged && !draft.canUndo);
    draft.redo();
    draft.redo();
    assert.equal(draft.document.objects[0].xyz[0], 0.7);
    draft.undo();
    draft.change((document) => {
      document.noun = "cup";
    });
    assert.ok(!draft.canRedo);
  });

  it("is changed until it is saved; what changes nothing is no step", () => {
    const draft = new Draft(opened());
    draft.change(() => {});
    assert.ok(!draft.isChanged && !draft.canUndo);
    assert.ok(new Draft({ ...opened(), hash: null }).isChanged);
    draft.change((document) => document.objects.pop());
    draft.setSaved({ ...opened(), document: draft.document, hash: "i" });
    assert.ok(!draft.isChanged && !draft.canUndo);
  });
});

describe("the map of the reach", () => {
  /** Within 0.8 m of a shoulder; answers for as many places as it likes. */
  const arm = (most = 1000) => {
    const asked = [];
    const ask = async (_, at) => {
      asked.push(...at);
      const limbs = at.slice(0, most).map(([x, y]) => (Math.hypot(x, y) < 0.8 ? "left" : null));
      return { limbs, why: "too far" };
    };
    return { asked, ask };
  };

  it("asks finely only where the answer changes", async () => {
    const { asked, ask } = arm();
    const map = new ReachMap();
    let changes = 0;
    await map.fill(thing("a", 0.6, 0), ask, () => changes++);
    assert.ok(map.isComplete && changes > 1);
    assert.ok(asked.length < 700, `${asked.length} of 1881`);
    assert.equal(new Set(asked.map(String)).size, asked.length, "no place twice");
    assert.equal(map.at(0.6, 0), "left");
    assert.equal(map.at(0.75, 0), "left");
    assert.equal(map.at(0.85, 0), null);
    assert.equal(map.at(3, 0), null);
    const wide = map.stretches().filter(({ limb }) => limb === "left");
    const area = wide.reduce((sum, { from, to }) => sum + 0.05 * (to - from), 0);
    assert.ok(area > 0.9 && area < 1.4, String(area));
  });

  it("asks again for what there was no time for, and ends where nothing is answered", async () => {
    const { ask } = arm(7);
    const map = new ReachMap();
    await map.fill(thing("a", 0.6, 0), ask, () => {});
    assert.equal(map.at(0.75, 0), "left");
    const silent = new ReachMap();
    await silent.fill(
      thing("a", 0.6, 0),
      async () => ({ limbs: [], why: null }),
      () => {},
    );
    assert.ok(!silent.isComplete);
    assert.equal(silent.at(0.6, 0), undefined);
  });

  it("is that of objects with the same shape and height", () => {
    const [a, b] = [thing("a", 0.6, 0), thing("b", 0.2, 0.3)];
    assert.equal(reachKey(a), reachKey(b));
    assert.notEqual(reachKey(a), reachKey({ ...a, yaw: 1 }));
    assert.notEqual(reachKey(a), reachKey({ ...a, xyz: [0.6, 0, 0] }));
  });
});

describe("the editor's session", () => {
  /** A server with one scene. */
  function server() {
    const calls = [];
    const opened = {
      name: "s",
      text: "text",
      hash: "1",
      document: scene(thing("a", 0.6, 0)),
      robot: { hand_over_xyz_m: [0.75, 0, 0.1], table_z_m: -0.155, limbs: [] },
    };
    const state = { problems: [], stale: false, in_force_hash: "0" };
    const found = () => ({ problems: state.problems, warnings: [], words: ["red box"] });
    const api = {
      list: async () => ({
        names: ["s"],
        in_force: "s",
        in_force_hash: state.in_force_hash,
        locked: null,
      }),
      open: async () => structuredClone(opened),
      create: async () => ({ ...structuredClone(opened), name: null, hash: null }),
      check: async (draft) => {
        calls.push(["check", draft]);
        return found();
      },
      reach: async (_, at) => ({ limbs: at.map(() => "left"), why: null }),
      save: async (name, saving) => {
        calls.push(["save", name, saving]);
        if (state.stale) throw new Refused(409, { error: "it has changed" });
        return { name, text: "new", hash: "2", document: saving.document, ...found() };
      },
      use: async (name) => {
        calls.push(["use", name]);
        state.in_force_hash = "2";
      },
    };
    return { api, calls, state };
  }
  function begun({ isOperator = true } = {}) {
    const made = server();
    const notes = [];
    const session = new SceneSession(made.api, {
      t: (key) => key,
      isOperator: () => isOperator,
      onChange: () => {},
      notify: (text) => notes.push(text),
    });
    return { ...made, session, notes };
  }
  const settled = async (session, is) => {
    for (let tries = 0; tries < 200 && !is(session); tries++) {
      await new Promise((resolve) => setTimeout(resolve, 20));
    }
    assert.ok(is(session));
  };

  it("opens the scene in force, checks it, and asks for the reach", async () => {
    const { session, calls } = begun();
    await session.begin();
    assert.equal(session.draft.name, "s");
    await settled(session, () => session.findings.state === "done" && session.reach?.isComplete);
    assert.deepEqual(session.findings.words, ["red box"]);
    assert.equal(session.reach.at(0.6, 0), "left");
    const checks = calls.length;
    for (const x of [0.61, 0.62, 0.63]) {
      session.changeObject(0, (object) => object.xyz.splice(0, 1, x), "move 0");
    }
    await settled(session, () => session.findings.state === "done");
    assert.equal(calls.length, checks + 1, "one check of the last one");
    assert.equal(calls.at(-1)[1].document.objects[0].xyz[0], 0.63);
  });

  it("saves under its own name with what it knows, under another one as a new file", async () => {
    const { session, calls, state, notes } = begun();
    await session.begin();
    session.add(null);
    await session.save("s");
    assert.deepEqual(calls.at(-1).slice(0, 2), ["save", "s"]);
    assert.equal(calls.at(-1)[2].known, "1");
    assert.ok(!session.draft.isChanged && session.draft.hash === "2");
    await session.save("other");
    assert.equal(calls.at(-1)[2].known, null);
    assert.equal(calls.at(-1)[2].document.name, "other");
    await session.use();
    assert.deepEqual(calls.at(-1), ["use", "other"]);
    assert.deepEqual(notes.at(-1), "scene.used");
    state.stale = true;
    session.change((document) => document.objects.pop());
    await session.save("other");
    assert.equal(session.note, "it has changed");
    assert.ok(session.draft.isChanged, "nothing is lost");
  });

  it("changes nothing for those who only look on", async () => {
    const { session, calls } = begun({ isOperator: false });
    await session.begin();
    assert.equal(session.add(null), undefined);
    session.step("undo");
    assert.equal(session.draft.document.objects.length, 1);
    await new Promise((resolve) => setTimeout(resolve, 500));
    assert.deepEqual(calls, []);
  });
});
