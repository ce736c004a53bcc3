// The names in the arm's picture, and a click on an object.

import { drawn, drawnFinely, nameInPicture } from "../lib/arm.mjs";
import { WITH_PICTURE } from "../lib/chromium.mjs";
import { t } from "../lib/strings.mjs";
import { transcript } from "../lib/talk.mjs";
import { expect, test } from "../lib/test.mjs";

test.use(WITH_PICTURE);

const SIZES = {
  desktop: { width: 1440, height: 900 },
  small: { width: 1280, height: 720 },
  phone: { width: 390, height: 844 },
};

/** Places of the names, of the buttons, and of the picture, pixels of the page. */
const layout = (page) =>
  page.evaluate(() => {
    const rect = (node) => {
      const { x, y, width, height } = node.getBoundingClientRect();
      return { x, y, width, height };
    };
    const rects = (what) => [...document.querySelectorAll(what)].map(rect);
    const [stage] = rects(".arm-stage");
    return { stage, labels: rects(".arm-label"), tools: rects(".arm-tools") };
  });

const covers = (a, b) =>
  Math.min(a.x + a.width, b.x + b.width) - Math.max(a.x, b.x) > 0.5 &&
  Math.min(a.y + a.height, b.y + b.height) - Math.max(a.y, b.y) > 0.5;

/** What is wrong with the names of the objects, if anything. */
async function faults(page, count) {
  const { stage, labels, tools } = await layout(page);
  if (labels.length !== count) return [`${labels.length} names of ${count} objects`];
  const found = [];
  for (const [n, label] of labels.entries()) {
    const isIn =
      label.x >= stage.x - 1 &&
      label.y >= stage.y - 1 &&
      label.x + label.width <= stage.x + stage.width + 1 &&
      label.y + label.height <= stage.y + stage.height + 1;
    if (!isIn || label.width < 10) found.push(`${n} is not in the picture`);
    if (tools.some((tool) => covers(label, tool))) found.push(`${n} covers the buttons`);
    for (const [k, other] of labels.entries()) {
      if (k > n && covers(label, other)) found.push(`${n} covers ${k}`);
    }
  }
  return found;
}

test("every object has its name in the picture at every size, and none covers another", async ({
  console: page,
  group,
}) => {
  const { scene } = await group.state();
  for (const [size, viewport] of Object.entries(SIZES)) {
    await page.setViewportSize(viewport);
    if (size === "phone") await page.getByRole("button", { name: t("tab.arm") }).click();
    await drawn(page);
    await expect
      .poll(() => faults(page, scene.objects.length), { message: size, timeout: 60_000 })
      .toEqual([]);
  }
});

test("the operator says an object by a click on it; a pointer over it shows its name", async ({
  console: page,
  group,
}) => {
  await expect(page.getByText(t("control.mine"))).toBeVisible();
  await drawnFinely(page);
  const { scene } = await group.state();
  const { description } = scene.objects[1];
  const words = nameInPicture(scene.objects[1], scene);
  const name = page.locator(".arm-label").filter({ hasText: words });
  const { x, y, width, height } = await name.boundingBox();
  await page.mouse.move(x + width / 2, y + height / 2);
  await expect(name).toHaveAttribute("data-hover", "");
  await page.mouse.down();
  await page.mouse.up();
  await expect(transcript(page)).toContainText(`the ${description}`);
});

test("an object is said by keyboard, too", async ({ console: page, group }) => {
  await expect(page.getByText(t("control.mine"))).toBeVisible();
  await drawn(page);
  const { scene } = await group.state();
  const { description } = scene.objects[0];
  const name = nameInPicture(scene.objects[0], scene);
  await page.locator(".arm-label").getByRole("button", { name }).focus();
  await page.keyboard.press("Enter");
  await expect(transcript(page)).toContainText(`the ${description}`);
});

test("a click of a viewer on an object says nothing", async ({ page, group, watched }) => {
  void watched;
  await page.goto(group.link("/?role=viewer"));
  await drawnFinely(page);
  await expect(page.locator(".arm-label")).not.toHaveCount(0);
  await expect(page.locator(".arm-label button")).toHaveCount(0);
  const name = page.locator(".arm-label").first();
  const { x, y, width, height } = await name.boundingBox();
  await page.mouse.click(x + width / 2, y + height / 2);
  await expect(name).toHaveAttribute("data-hover", "");
  expect((await group.state()).lines).toEqual([]);
});
