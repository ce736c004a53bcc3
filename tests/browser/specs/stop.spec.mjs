// The motion stop.

import { WITHOUT_PICTURE } from "../lib/chromium.mjs";
import { expectStopped, resume, resumeButton } from "../lib/resume.mjs";
import { t } from "../lib/strings.mjs";
import { answerUntilPicked, expectDelivered, stopByKey, type } from "../lib/talk.mjs";
import { expect, test } from "../lib/test.mjs";

test.use(WITHOUT_PICTURE);

const stopped = async (group) => (await group.state()).arm.stopped;
const stop = (page) => page.getByRole("button", { name: t("stop.stop") });

test.describe("while the arm moves", () => {
  // A pick that lasts long enough to be stopped by a person.
  test.use({ settings: ["arm.time_scale=1"] });

  test("one press stops it, a held Resume lets it go on, and the bowl still comes", async ({
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

    const button = resumeButton(page);
    await expect(button).toHaveAccessibleDescription(t("resume.hold"));
    await button.click();
    await stop(page).click();
    expect(await stopped(group), "a short press does not move the arm").toBe(true);
    await resume(page, group);
    await expect(button).toBeHidden();
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
  await expectStopped(page);
});
