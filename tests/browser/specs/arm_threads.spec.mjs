// Who draws the arm's picture: a worker or, where workers cannot, the page itself.

import {
  arm,
  BROWSERS_BY_THREAD,
  distance,
  drawn,
  drawnFinely,
  nameInPicture,
  shown,
} from "../lib/arm.mjs";
import { WITH_PICTURE } from "../lib/chromium.mjs";
import { t } from "../lib/strings.mjs";
import { expect, test } from "../lib/test.mjs";

test.use(WITH_PICTURE);

const stage = (page) => page.locator(".arm-stage");
const notice = (page) => page.locator(".arm-notice");

/** How much two pictures differ: of 255, on average. */
const difference = (page, pictures) =>
  page.evaluate(
    async (texts) => {
      const [a, b] = await Promise.all(texts.map(pixels));
      return a.reduce((sum, value, n) => sum + Math.abs(value - b[n]), 0) / a.length;

      async function pixels(text) {
        const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
        const image = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
        const context = new OffscreenCanvas(image.width, image.height).getContext("2d");
        context.drawImage(image, 0, 0);
        return context.getImageData(0, 0, image.width, image.height).data;
      }
    },
    pictures.map((picture) => picture.toString("base64")),
  );

for (const [thread, make] of Object.entries(BROWSERS_BY_THREAD)) {
  test.describe(`a picture drawn by the ${thread}`, () => {
    test.beforeEach(async ({ page, group, watched }) => {
      void watched;
      await make(page);
      await page.goto(group.link());
      await drawn(page);
      expect((await shown(page)).thread).toBe(thread);
    });

    test("has names over it, and is turned by keys, mouse and wheel", async ({ page, group }) => {
      await page.setViewportSize({ width: 1900, height: 1000 });
      const { scene } = await group.state();
      const label = page.locator(".arm-label");
      await expect(label.first()).toContainText(nameInPicture(scene.objects[0], scene));

      const { eye } = await shown(page);
      const isFrom = (from, expected) =>
        expected(expect.poll(async () => distance((await shown(page)).eye, from)));
      const isElsewhere = (from) => isFrom(from, (poll) => poll.toBeGreaterThan(0.1));
      const comesBack = async () => {
        await page.getByRole("button", { name: t("arm.view.start") }).click();
        await isFrom(eye, (poll) => poll.toBeLessThan(0.001));
      };
      await stage(page).focus();
      await page.keyboard.press("ArrowRight");
      await isElsewhere(eye);
      await comesBack();

      const { x, y } = await stage(page).boundingBox();
      await page.mouse.move(x + 60, y + 60);
      await page.mouse.down();
      await page.mouse.move(x + 120, y + 60, { steps: 3 });
      await page.mouse.up();
      await isElsewhere(eye);
      const turned = (await shown(page)).eye;
      await page.mouse.move(x + 60, y + 60);
      expect(distance((await shown(page)).eye, turned), "after the button was let go").toBe(0);
      await comesBack();

      await page.mouse.move(x + 60, y + 60);
      await page.mouse.wheel(0, 300);
      await isElsewhere(eye);
    });

    test("comes back whole after the graphics card was lost", async ({ page }) => {
      await drawnFinely(page);
      const before = await stage(page).screenshot();
      await arm(page).evaluate((element) => element.armView.lose());
      await expect(notice(page)).toHaveText(t("arm.lost"));
      const without = await stage(page).screenshot();
      await arm(page).evaluate((element) => element.armView.restore());
      await drawnFinely(page);
      await expect(notice(page)).toBeHidden();
      await expect
        .poll(async () => difference(page, [before, await stage(page).screenshot()]))
        .toBeLessThan(1);
      expect(await difference(page, [before, without])).toBeGreaterThan(2);
    });
  });
}

test("a stop is carried out while the picture is busy", async ({ console: page, group }) => {
  await drawn(page);
  const spun = arm(page).evaluate(async (element) => {
    element.armView.spin(30_000).then(() => {
      element.dataset.spun = "";
    });
  });
  await spun;
  await page.getByRole("button", { name: t("stop.stop") }).click();
  await expect.poll(async () => (await group.state()).arm.stopped).toBe(true);
  await expect(page.locator(".arm-caption")).toHaveText(t("arm.stopped"));
  await expect(arm(page)).not.toHaveAttribute("data-spun");
});
