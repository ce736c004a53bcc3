// The one sheet of settings.

import { expectAccessible } from "../lib/axe.mjs";
import { t } from "../lib/strings.mjs";
import { expect, test } from "../lib/test.mjs";

test("what is set is in force at once, and still after a reload", async ({ console: page }) => {
  const root = page.locator("html");
  const open = () => page.getByRole("button", { name: t("settings.open"), exact: true }).click();
  const sheet = page.getByRole("dialog", { name: t("settings.title") });
  const choose = (group, value) =>
    sheet
      .getByRole("group", { name: t(group) })
      .getByRole("radio", { name: t(value) })
      .check();
  await open();
  await expect(sheet).toBeVisible();
  await choose("settings.theme", "settings.theme.dark");
  await choose("settings.text", "settings.text.larger");
  await choose("settings.motion", "settings.motion.less");
  await expect(root).toHaveAttribute("data-theme", "dark");
  await expectAccessible(page);
  await sheet.getByRole("checkbox", { name: t("settings.keys.single") }).uncheck();
  await sheet.getByRole("checkbox", { name: t("voice.sound") }).uncheck();
  await page.reload();
  for (const [name, value] of [
    ["theme", "dark"],
    ["text", "larger"],
    ["motion", "less"],
  ]) {
    await expect(root).toHaveAttribute(`data-${name}`, value);
  }
  await open();
  await expect(sheet.getByRole("checkbox", { name: t("settings.keys.single") })).not.toBeChecked();
  await expect(sheet.getByRole("checkbox", { name: t("voice.sound") })).not.toBeChecked();
  await page.keyboard.press("Escape");
  await page.keyboard.press("?");
  await expect(page.getByRole("dialog")).toHaveCount(0);
  await open();
  // The page is loaded again: there is nothing left whose state could be waited for.
  await sheet.getByRole("radio", { name: "Deutsch" }).click();
  await expect(root).toHaveAttribute("lang", "de");
});
