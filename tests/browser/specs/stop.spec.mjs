// The motion stop.

import { WITHOUT_PICTURE } from "../lib/chromium.mjs";
import { t } from "../lib/strings.mjs";
import { answerUntilPicked, expectDelivered, stopByKey, type } from "../lib/talk.mjs";
import { expect, test } from "../lib/test.mjs";

test.use(WITHOUT_PICTURE);

const stopped = async (group) => (await group.state()).arm.stopped;
const stop = (page) => page.getByRole("button", { name: t("stop.stop") });

test.describe("while the arm moves", () => {
  // A pick that lasts long enough to be stopped by a person.
  test.use({ settings: ["arm.time_scale=1"] });

  test("one press stops it, two resume it, and the bowl still comes", async ({
    console: page,
    group,
  }) => {
    await type(page, "get me the clear bowl");
    await answerUntilPicked(page, group, "clear");
    await expect.poll(async () => (await group.state()).arm.moving).toBe(true);
    await page.keyboard.press("Escape");
    await expect.poll(() => stopped(group)).toBe(true);
    await expect(page.getByRole("alert").filter({ hasText: t("alarm.stopped") })).toBeAttached();
    await expect.poll(async () => (await group.state()).arm.moving).toBe(false);

    // Presses that follow at once are not meant for what the button has become, and do nothing.
    const resume = page.getByRole("button", { name: t("stop.resume") });
    const confirm = page.getByRole("button", { name: t("stop.confirm") });
    await expect(async () => {
      await resume.click({ timeout: 2_000 });
      await expect(confirm).toBeVisible({ timeout: 2_000 });
    }).toPass();
    expect(await stopped(group), "one press does not move the arm").toBe(true);
    await expect(async () => {
      for (const button of [resume, confirm]) {
        if (await button.isVisible()) await button.click({ timeout: 2_000 });
      }
      await expect.poll(() => stopped(group), { timeout: 4_000 }).toBe(false);
    }).toPass();
    await expectDelivered(page, group, "clear");
  });
});

test("it works from the text field, by keyboard alone", async ({ console: page, group }) => {
  await page.getByRole("textbox", { name: t("say.label") }).focus();
  await stopByKey(page);
  expect(await stopped(group)).toBe(true);
});

test("it works while the page is busy", async ({ console: page, group }) => {
  await expect(stop(page)).toBeEnabled();
  const box = await stop(page).boundingBox();
  // Work that leaves the page hardly any time, for as long as the test lasts.
  await page.evaluate(() => {
    const spin = () => {
      const end = performance.now() + 150;
      while (performance.now() < end);
      setTimeout(spin, 0);
    };
    spin();
  });
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await expect.poll(() => stopped(group)).toBe(true);
  await page.mouse.up();
});

test("without the arm's service it warns, with the reason, until the arm confirms", async ({
  console: page,
  group,
}) => {
  await group.must("hold", "arm");
  await expect(page.getByText(t("arm.unknown"))).toBeAttached();
  await expect(page.getByText(t("health.off", { names: "arm" }))).toBeAttached();
  const alarm = page
    .getByRole("alert")
    .filter({ hasText: t("alarm.unconfirmed", { why: t("alarm.why.held") }) });
  const pressed = Date.now();
  await stop(page).click();
  await expect(alarm).toBeVisible();
  test.info().annotations.push({ type: "alarm after, ms", description: `${Date.now() - pressed}` });
  await expect(page.getByText(t("stop.unconfirmed"))).toBeVisible();

  // It stays: after a reload, and when the service comes back, until that has confirmed.
  await page.reload();
  await expect(alarm).toBeVisible();
  const release = page.getByRole("button", { name: t("services.act.release", { name: "arm" }) });
  if (!(await release.isVisible())) await page.locator(".health summary").click();
  await release.click();
  await expect(alarm).toBeHidden();
  await expect(page.getByRole("button", { name: t("stop.resume") })).toBeVisible();
});
