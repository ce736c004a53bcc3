// The page is small, in the user's language, and sends requests only to the robot.

import { WITH_PICTURE } from "../lib/chromium.mjs";
import { t } from "../lib/strings.mjs";
import { expect, test } from "../lib/test.mjs";

test.use(WITH_PICTURE);

/** Bytes of the first view as they cross the network, without the part in 3D. */
const FIRST_VIEW_BYTES_MAX = 300_000;

test("the first view is light, and the part in 3D comes after it", async ({
  page,
  group,
  watched,
}) => {
  void watched;
  const loaded = [];
  page.on("requestfinished", (request) => loaded.push(request));
  await page.goto(group.link());
  await expect(page.getByText(t("control.mine"))).toBeAttached();
  await expect.poll(() => loaded.some((request) => request.url().includes("/vendor/"))).toBe(true);

  const isLater = (url) => url.includes("/vendor/") || url.includes("/js/arm/");
  const first = loaded.filter((request) => !isLater(new URL(request.url()).pathname));
  const sizes = await Promise.all(first.map((request) => request.sizes()));
  const bytes = sizes.reduce((sum, { responseBodySize }) => sum + responseBodySize, 0);
  expect(bytes).toBeGreaterThan(10_000);
  expect(bytes).toBeLessThan(FIRST_VIEW_BYTES_MAX);

  const begun = (request) => request.timing().startTime;
  const view = Math.min(...loaded.filter((r) => r.url().includes("main.js")).map(begun));
  const arm = Math.min(...loaded.filter((r) => r.url().includes("/vendor/")).map(begun));
  expect(arm).toBeGreaterThan(view);
});

test.describe("in German", () => {
  test.use({ locale: "de-DE" });

  test("the page can be had", async ({ page, group, watched }) => {
    void watched;
    await page.goto(group.link("/?lang=de"));
    await expect(page.locator("html")).toHaveAttribute("lang", "de");
    await expect(page.getByText(t("control.mine"))).toHaveCount(0);
  });
});
