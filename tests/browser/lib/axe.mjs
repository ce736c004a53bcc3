// Accessibility, as axe-core judges it.

import AxeBuilder from "@axe-core/playwright";
import { expect } from "./test.mjs";

/**
 * Fails with what is wrong and where, if anything is.
 * @param {import("@playwright/test").Page} page
 */
export async function expectAccessible(page) {
  const { violations } = await new AxeBuilder({ page }).analyze();
  const found = violations.map(({ id, nodes }) => ({ id, where: nodes.map((node) => node.html) }));
  expect(found, "violations found by axe-core").toEqual([]);
}
