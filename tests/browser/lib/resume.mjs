// Resume, as a person holds it.

import { t } from "./strings.mjs";
import { expect } from "./test.mjs";

/** The button that is held. @param {import("@playwright/test").Page} page */
export const resumeButton = (page) =>
  page.getByRole("button", { name: t("resume.words"), exact: true });

/** STOP, which shows that the arm is stopped. @param {import("@playwright/test").Page} page */
export const expectStopped = (page, options = {}) =>
  expect(page.locator("#stop")).toHaveAttribute("data-state", "stopped", options);

/**
 * Holds Resume until the group's arm may move again: once more where a busy page has not counted it.
 * @param {import("@playwright/test").Page} page
 * @param {import("./group.mjs").Group} group
 */
export async function resume(page, group) {
  const stopped = async () => (await group.state()).arm.stopped;
  const button = resumeButton(page);
  await expect(async () => {
    if (!(await stopped())) return;
    await expect(button).not.toHaveAttribute("data-waits", { timeout: 5_000 });
    await button.hover({ timeout: 5_000 });
    await page.mouse.down();
    try {
      await expect.poll(stopped, { timeout: 5_000 }).toBe(false);
    } finally {
      await page.mouse.up();
    }
  }).toPass();
}
