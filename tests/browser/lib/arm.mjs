// The arm's picture, as tests see it.

import { expect } from "./test.mjs";

/** What makes a page's picture be drawn by a worker, as usual, or by the page itself. */
export const BROWSERS_BY_THREAD = {
  worker: async () => {},
  page: (page) =>
    page.addInitScript(() => {
      delete HTMLCanvasElement.prototype.transferControlToOffscreen;
    }),
};

/** @param {import("@playwright/test").Page} page */
export const arm = (page) => page.locator("#arm");

/** What the picture shows. @param {import("@playwright/test").Page} page */
export const shown = (page) => arm(page).evaluate((element) => element.armView?.shown() ?? null);

/** Between two places, metres. @param {number[]} a @param {number[]} b */
export const distance = (a, b) => Math.hypot(...a.map((value, k) => value - b[k]));

/** Waits until the robot is in the picture. @param {import("@playwright/test").Page} page */
export async function drawn(page) {
  const patience = { timeout: 60_000 };
  await expect(arm(page)).toHaveAttribute("data-state", "ready", patience);
  await expect(arm(page)).toHaveAttribute("data-picture", /coarse|fine/, patience);
}

/** Waits until the picture stands and is drawn finely. @param {import("@playwright/test").Page} page */
export const drawnFinely = (page) =>
  expect(arm(page)).toHaveAttribute("data-picture", "fine", { timeout: 60_000 });

/** What an object is called in the picture: its label without the noun, which all of them share. */
export const nameInPicture = ({ label }, { noun }) =>
  label
    .split(" ")
    .filter((word) => word !== noun)
    .join(" ");
