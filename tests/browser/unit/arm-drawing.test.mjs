import assert from "node:assert/strict";
import { describe, it } from "node:test";
import { TreeElement } from "../../../services/console/page/js/arm/elements.js";
import { MotionFigures } from "../../../services/console/page/js/arm/figures.js";
import { Picture } from "../../../services/console/page/js/arm/picture.js";
import { Pointed } from "../../../services/console/page/js/arm/pointed.js";
import { RobotModel } from "../../../services/console/page/js/arm/robot.js";
import { lightFrom, studio } from "../../../services/console/page/js/arm/studio.js";

const node = (name, attributes = {}, ...children) => ({ name, attributes, children });

describe("an element of the robot's description", () => {
  const robot = new TreeElement(
    node("robot", { name: "r" }, node("joint", { name: "j" }, node("child", { link: 'a"b' }))),
  );

  it("is one, to those who ask for elements", () => {
    assert.ok(robot instanceof Element);
    assert.equal(robot.nodeName, "robot");
    assert.equal(robot.getAttribute("name"), "r");
    assert.equal(robot.getAttribute("other"), null);
    assert.equal(robot.children[0].children.length, 1);
  });

  it("finds the joint that leads to a link", () => {
    assert.equal(robot.querySelector('child[link="a"b"]').nodeName, "child");
    assert.equal(robot.querySelector('child[link="r"]'), null);
    assert.throws(() => robot.querySelector("joint"));
  });

  it("is what a robot is made of", () => {
    const origin = node("origin", { xyz: "0 0 2", rpy: "0 0 0" });
    const box = node("visual", {}, node("geometry", {}, node("box", { size: "1 1 1" })));
    const model = new RobotModel(
      node(
        "robot",
        { name: "r" },
        node("link", { name: "base" }, box),
        node("link", { name: "left_gripper" }),
        node(
          "joint",
          { name: "j", type: "fixed" },
          origin,
          node("parent", { link: "base" }),
          node("child", { link: "left_gripper" }),
        ),
      ),
    );
    assert.equal(model.bodies, 1);
    assert.deepEqual(model.placeOf("left_gripper"), [0, 0, 2]);
  });
});

describe("the picture's messages", () => {
  it("send messages, requests and events of the drawing", async () => {
    const { port1, port2 } = new MessageChannel();
    const heard = [];
    const picture = new Picture(port1, (message) => heard.push(message));
    port2.onmessage = ({ data: { id, what, args } }) => {
      if (id === undefined) port2.postMessage({ sent: what });
      else if (what === "fail") port2.postMessage({ id, error: "no" });
      else port2.postMessage({ id, value: [what, ...args] });
    };
    picture.call("look", "above");
    assert.deepEqual(await picture.ask("forward", 1, 2), ["forward", 1, 2]);
    await assert.rejects(picture.ask("fail"), /^Error: no$/);
    assert.deepEqual(heard, [{ sent: "look" }]);
    port1.close();
  });

  it("dispatch events without an element", () => {
    const pointed = new Pointed();
    const seen = [];
    pointed.ownerDocument.addEventListener("wheel", ({ type, deltaY }) => seen.push(type, deltaY));
    pointed.happen("wheel", { deltaY: 3 });
    assert.deepEqual(seen, ["wheel", 3]);
  });
});

describe("the studio that shiny things mirror", () => {
  const panel = (low, high, light) => ({ low, high, light });
  const room = {
    walls: [1, 1, 1],
    panels: [panel([-1, -1, 4], [1, 1, 5], [2, 0, 0]), panel([-9, -9, 7], [9, 9, 8], [0, 3, 0])],
  };

  it("shows what is nearest in a direction, and the walls where nothing is", () => {
    assert.deepEqual(lightFrom(room, 0.001, 0.002, 1), [2, 0, 0]);
    assert.deepEqual(lightFrom(room, 0.8, 0.001, 1), [0, 3, 0], "beside the nearer one");
    assert.deepEqual(lightFrom(room, 0.001, 0.002, -1), [1, 1, 1], "not what is behind");
  });

  it("has one level more than materials read, each of half the size", () => {
    const texture = studio(false);
    const sizes = [texture.image, ...texture.mipmaps.map(({ image }) => image)].map(
      (sides) => sides[0].image.width,
    );
    assert.deepEqual(sizes, [32, 16, 8, 4]);
    assert.equal(texture.image.length, 6);
    const lights = texture.mipmaps.flatMap(({ image }) =>
      image.flatMap((side) => [...side.image.data]),
    );
    assert.ok(
      lights.every((half) => half < 0x7c00),
      "no infinity, no negative light",
    );
  });
});

describe("figures of a motion", () => {
  it("leave out what does not count", () => {
    const figures = new MotionFigures();
    assert.equal(figures.all.fps, null);
    figures.add({ interval: null, work: 3, late: null });
    figures.add({ interval: 20, work: 5, late: 40 });
    const { fps, count, work_ms, state_to_picture_ms } = figures.all;
    assert.deepEqual([fps, count, work_ms.p99, state_to_picture_ms.p50], [50, 1, 5, 40]);
    figures.clear();
    assert.equal(figures.all.count, 0);
  });
});
