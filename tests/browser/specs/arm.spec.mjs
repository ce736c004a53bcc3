// The arm in 3D.

import { readFile } from "node:fs/promises";
import { join } from "node:path";
import { arm, distance, drawn, drawnFinely, shown } from "../lib/arm.mjs";
import { expectAccessible } from "../lib/axe.mjs";
import { WITH_PICTURE } from "../lib/chromium.mjs";
import { ROOT } from "../lib/program.mjs";
import { t } from "../lib/strings.mjs";
import { answerUntilPicked, expectDelivered, type } from "../lib/talk.mjs";
import { expect, test } from "../lib/test.mjs";

test.use(WITH_PICTURE);

const file = (path) => readFile(join(ROOT, path), "utf8");

/** The `joints` messages that the page gets from now on. */
async function listen(page) {
  const messages = [];
  page.on("websocket", (socket) =>
    socket.on("framereceived", ({ payload }) => {
      if (typeof payload !== "string" || !payload.includes('"joints"')) return;
      const message = JSON.parse(payload);
      if (message.t === "joints") messages.push(message);
    }),
  );
  await page.reload();
  return messages;
}

/**
 * Notes what the picture shows, as often as it can say so. Returns what ends that, and returns what was noted.
 * @param {import("@playwright/test").Page} page
 */
async function follow(page) {
  const notes = await arm(page).evaluateHandle((element) => {
    const notes = { moments: [], over: false };
    const note = async () => {
      notes.moments.push(await element.armView.shown());
      if (!notes.over) requestAnimationFrame(note);
    };
    void note();
    return notes;
  });
  return () =>
    notes.evaluate((notes) => {
      notes.over = true;
      return notes.moments;
    });
}

/** Whether the elbows lie between those of the messages. */
const isBetween = (joints, messages) =>
  [
    ["left_e1", 3],
    ["right_e1", 10],
  ].every(([name, n]) => {
    const values = messages.map(({ q }) => q[n]);
    return joints[name] >= Math.min(...values) - 1e-6 && joints[name] <= Math.max(...values) + 1e-6;
  });

test("the robot is drawn whole, and every object stands where the scene has it", async ({
  console: page,
  group,
}) => {
  await drawn(page);
  const { robot, bodies, objects, held } = await shown(page);
  const description = await file("config/robots/baxter.urdf");
  expect(robot).toBe("baxter");
  expect(bodies).toBe(description.match(/<visual>/g).length);
  const { scene } = await group.state();
  expect(objects).toHaveLength(scene.objects.length);
  for (const [n, object] of scene.objects.entries()) {
    expect(distance(objects[n], object.xyz), object.name).toBeLessThan(0.001);
  }
  expect(held).toBe(-1);
  await expect(page.locator(".arm-caption")).toHaveText(t("arm.resting"));
  await expectAccessible(page);
});

test("its kinematics are those of the reference", async ({ console: page }) => {
  await drawn(page);
  for (const limb of ["left", "right"]) {
    const [head, ...rows] = (await file(`tests/fixtures/baxter/fk_reference_${limb}.csv`))
      .trim()
      .split("\n")
      .map((line) => line.split(","));
    const names = head.slice(0, 7).map((name) => name.replace("q_", `${limb}_`));
    const column = head.indexOf("gripper_electric_x");
    const cases = rows.map((row) => ({
      joints: Object.fromEntries(names.map((name, n) => [name, Number(row[n])])),
      place: row.slice(column, column + 3).map(Number),
    }));
    const places = await arm(page).evaluate(
      (element, [link, postures]) =>
        Promise.all(postures.map((q) => element.armView.forward(q, link))),
      [`${limb}_gripper`, cases.map(({ joints }) => joints)],
    );
    for (const [n, { place }] of cases.entries()) {
      expect(distance(places[n], place), `${limb} ${n}`).toBeLessThan(1e-5);
    }
  }
});

test("a robot with joints of other names and mesh files is drawn by what can be had", async ({
  page,
  group,
  watched,
}) => {
  void watched;
  const baxter = await file("config/robots/baxter.urdf");
  const [whole] = baxter.match(/<link name="left_upper_shoulder">[\s\S]*?<\/link>/);
  const count = (text, tag) => (text.match(new RegExp(`<${tag}>`, "g")) ?? []).length;
  const meshes = whole.replace(/<visual>.*?<\/visual>/g, (visual) =>
    visual.replace(/<geometry>.*<\/geometry>/, '<geometry><mesh filename="a.stl"/></geometry>'),
  );
  const own = baxter
    .replace(whole, meshes)
    .replace(/(joint name|mimic joint)="left_([sew][0-2])"/g, '$1="own_$2"');
  const files = [];
  page.on("request", (request) => request.url().endsWith(".stl") && files.push(request.url()));
  await page.route("**/robot.urdf", (route) => route.fulfill({ body: own }));
  await page.goto(group.link());
  await drawn(page);
  const { bodies, joints } = await shown(page);
  expect(joints).toHaveProperty("own_s0");
  expect(count(whole, "collision")).toBeGreaterThan(0);
  expect(bodies).toBe(count(baxter, "visual") - count(whole, "visual") + count(whole, "collision"));
  const tip = (await group.state()).world.grippers[0].slice(0, 3);
  await expect.poll(async () => distance((await shown(page)).grippers[0], tip)).toBeLessThan(0.002);
  expect(files, "mesh files that were asked for").toEqual([]);
});

test.describe("an invalid robot description", () => {
  // Browsers say what is wrong in an element with a style of its own, which the page forbids.
  test.use({ provoked: ["inline style"] });

  test("is reported and retried", async ({ page, group, watched }) => {
    void watched;
    await page.route("**/robot.urdf", (route) => route.fulfill({ body: "<robot><link></robot>" }), {
      times: 2,
    });
    await page.goto(group.link());
    const notice = page.locator(".arm-notice");
    const [before] = t("arm.no_robot", { why: "|" }).split("|");
    await expect(notice).toContainText(before);
    await expect(notice).toContainText("line 1");
    await drawn(page);
    await expect(notice).toBeHidden();
  });
});

test("a picture in which nothing happens is not drawn again", async ({ console: page }) => {
  await drawn(page);
  await page.evaluate(() => document.fonts.ready);
  const frames = async () => (await shown(page)).frames;
  const after = (count) =>
    page.evaluate(async (n) => {
      for (; n > 0; n--) await new Promise((done) => requestAnimationFrame(done));
    }, count);
  let before = -1;
  await expect
    .poll(async () => {
      const last = before;
      await after(60);
      before = await frames();
      return before - last;
    })
    .toBe(0);
});

test.describe("a pick", () => {
  // Slower than real time, so that also a machine that draws two frames a second has something to see, and once
  // everything is made that is drawn with.
  test.use({ settings: ["arm.time_scale=0.3"] });

  test("is followed from the order to the hand-over", async ({ console: page, group }) => {
    const messages = await listen(page);
    await drawnFinely(page);
    const followed = await follow(page);
    await type(page, "the big clear bowl");
    await answerUntilPicked(page, group, "clear");
    await expectDelivered(page, group, "clear");
    const moments = await followed();

    expect(moments.some((moment) => moment.trajectory)).toBe(true);
    const held = moments.filter((moment) => moment.held !== -1);
    // That it is held is told before it is drawn.
    const carried = held.filter(({ frames }) => frames > held[0].frames);
    const { scene } = await group.state();
    const names = carried.map(({ held }) => scene.objects[held].name);
    expect(new Set(names)).toEqual(new Set(["clear"]));
    const way = carried.map(({ held, objects }) => objects[held]);
    expect(distance(way[0], way.at(-1)), "it was carried").toBeGreaterThan(0.2);
    const apart = carried.map(({ grippers }, n) =>
      Math.min(...grippers.map((gripper) => distance(gripper, way[n]))),
    );
    expect(Math.max(...apart) - Math.min(...apart), "by the gripper").toBeLessThan(0.002);
    // What was drawn lies between messages that came one after another.
    for (const { joints } of carried) {
      const between = messages.some((_, n) => isBetween(joints, messages.slice(n, n + 3)));
      expect(between, JSON.stringify(joints)).toBe(true);
    }
    await expect.poll(async () => (await shown(page)).trajectory).toBe(false);
    const figures = await arm(page).evaluate((element) => element.armView.stats());
    expect(figures.count).toBeGreaterThan(0);
    test.info().annotations.push({ type: "picture", description: JSON.stringify(figures) });
  });

  test("that is stopped is seen to be", async ({ console: page, group }) => {
    await drawnFinely(page);
    await type(page, "the big clear bowl");
    await answerUntilPicked(page, group, "clear");
    await expect.poll(async () => (await shown(page)).trajectory).toBe(true);
    await page.keyboard.press("Escape");
    await expect(page.locator(".arm-badge")).toBeVisible();
    await expect(page.locator(".arm-caption")).toHaveText(t("arm.stopped"));
    await expect.poll(async () => (await shown(page)).trajectory).toBe(false);
    await expect.poll(async () => (await group.state()).arm.moving).toBe(false);
    // The world is published once a second while the arm is at rest.
    const apart = async (n) => {
      const { world } = await group.state();
      return distance((await shown(page)).grippers[n], world.grippers[n].slice(0, 3));
    };
    for (const n of [0, 1]) await expect.poll(() => apart(n)).toBeLessThan(0.002);
    expect((await shown(page)).held).toBe(-1);
  });
});
