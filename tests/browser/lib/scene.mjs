// The scene editor, as a person uses it.

import { t } from "./strings.mjs";
import { expect } from "./test.mjs";

const KINDS = ["cup", "box", "ball"];
const COLOURS = ["red", "blue", "green"];
/** Nine objects: every kind in every colour. */
export const NINE = KINDS.flatMap((kind) =>
  COLOURS.map((color) => ({ name: `${color}_${kind}`, kind, color })),
);

/** The editor's sheet. @param {import("@playwright/test").Page} page */
export const sheet = (page) => page.getByRole("dialog", { name: t("scene.title") });

/** Opens the editor. @param {import("@playwright/test").Page} page */
export async function openEditor(page) {
  await page.getByRole("button", { name: t("scene.show"), exact: true }).click();
  await expect(sheet(page).getByRole("combobox", { name: t("scene.which") })).toBeEnabled();
}

/** An object in the picture. @param {import("@playwright/test").Page} page @param {string} name */
export const thing = (page, name) => sheet(page).locator(`.thing[data-name="${name}"]`);

const button = (page, key, args = {}) =>
  sheet(page).getByRole("button", { name: t(key, args), exact: true });

/** Waits until the latest change is checked. @param {import("@playwright/test").Page} page */
export async function checked(page) {
  await expect(sheet(page)).toHaveAttribute("data-check", "done");
}

/** Adds a value to an attribute. */
async function addValue(page, attribute, value, spoken) {
  const form = sheet(page).locator("details.attribute").filter({ hasText: attribute });
  const rows = form.locator(".value-row");
  const count = await rows.count();
  await form.getByRole("button", { name: t("scene.value.add"), exact: true }).click();
  await expect(rows).toHaveCount(count + 1);
  const row = rows.nth(count);
  await row.getByLabel(t("scene.value.name"), { exact: true }).fill(value);
  if (spoken) await row.getByLabel(t("scene.value.spoken")).fill(spoken);
}

/**
 * Writes a scene of nine objects from a new one: the words, an object, and eight others like it.
 * @param {import("@playwright/test").Page} page
 */
export async function authorNine(page) {
  await button(page, "scene.new").click();
  await button(page, "scene.panel.words").click();
  await expect(sheet(page).locator("details.attribute")).toHaveCount(2);
  await addValue(page, "kind", "ball", "a ball");
  await addValue(page, "color", "green");
  await button(page, "scene.panel.object").click();
  await expect(sheet(page).getByText(t("scene.empty"))).toBeVisible();
  for (const [n, { name, kind, color }] of NINE.entries()) {
    await button(page, n === 0 ? "scene.add" : "scene.copy").click();
    await expect(sheet(page).locator(".thing")).toHaveCount(n + 1);
    await sheet(page).getByLabel(t("scene.object.name")).fill(name);
    await sheet(page).getByRole("combobox", { name: "kind" }).selectOption(kind);
    await sheet(page).getByRole("combobox", { name: "color" }).selectOption(color);
    await expect(thing(page, name)).toHaveAttribute("aria-pressed", "true");
  }
}

/**
 * Follows the proposals until there is no problem. @param {import("@playwright/test").Page} page
 */
export async function solveProblems(page) {
  const done = sheet(page).getByText(t("scene.check.done"));
  const move = button(page, "scene.move").first();
  await expect(async () => {
    await checked(page);
    // A check that ends meanwhile takes the button away.
    if (await move.isVisible()) await move.click({ timeout: 1000 });
    await expect(done).toBeVisible({ timeout: 1000 });
  }).toPass();
}

/** Saves under a name. @param {import("@playwright/test").Page} page @param {string} name */
export async function saveAs(page, name) {
  await sheet(page).getByLabel(t("scene.name"), { exact: true }).fill(name);
  await button(page, "scene.save").click();
  await expect(page.getByText(t("scene.saved", { name }))).toBeVisible();
}
