// Somebody who takes part in a study, with the keyboard only.

import { t } from "./strings.mjs";
import { expect } from "./test.mjs";

/**
 * Waits for a screen of the participant's page.
 * @param {import("@playwright/test").Page} page
 * @param {string} name
 */
export const screen = (page, name) =>
  expect(page.locator("body")).toHaveAttribute("data-screen", name);

/**
 * Presses a button by keyboard.
 * @param {import("@playwright/test").Page} page
 * @param {string} key of its words
 */
export async function press(page, key) {
  const button = page.getByRole("button", { name: t(key), exact: true });
  await expect(button).toBeEnabled();
  await button.focus();
  await page.keyboard.press("Enter");
}

/**
 * Starts the interaction whose card is shown, and asks for something.
 * @param {import("@playwright/test").Page} page
 * @returns {Promise<string>} name of the desired object
 */
export async function request(page) {
  await screen(page, "drawn");
  const desired = await page.locator("#screen [data-object]").getAttribute("data-object");
  await press(page, "study.start");
  await screen(page, "running");
  await page.getByRole("textbox", { name: t("say.label") }).fill("get me the bowl");
  await page.keyboard.press("Enter");
  return desired ?? "";
}

/**
 * Answers the robot's questions truthfully until it has handed something over.
 * @param {import("@playwright/test").Page} page
 * @param {import("./group.mjs").Group} group
 * @param {string} desired name of the desired object
 */
export async function finish(page, group, desired) {
  await group.call("await", "pick", "--answer-as", desired, "--timeout", "50");
  await screen(page, "over");
  await expect(page.getByText(t("study.outcome.right"))).toBeVisible();
}

/**
 * Gives every statement of the questionnaire the same mark.
 * @param {import("@playwright/test").Page} page
 * @param {number} mark
 */
export async function rate(page, mark) {
  for (const scale of await page.locator(".study-form fieldset").all()) {
    await scale.getByRole("radio", { name: String(mark), exact: true }).focus();
    await page.keyboard.press("Space");
  }
}
