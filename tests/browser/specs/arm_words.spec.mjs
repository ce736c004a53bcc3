// A browser without WebGL: text replaces the drawing of the arm.

import { arm, BROWSERS_BY_THREAD } from "../lib/arm.mjs";
import { t } from "../lib/strings.mjs";
import { expect, test } from "../lib/test.mjs";

for (const [thread, make] of Object.entries(BROWSERS_BY_THREAD)) {
  test(`words say what the arm does where the ${thread} would draw it`, async ({
    page,
    group,
    watched,
  }) => {
    void watched;
    await make(page);
    await page.goto(group.link());
    await expect(page.locator(".arm-notice")).toHaveText(t("arm.no_webgl"));
    await expect(page.locator(".arm-caption")).toHaveText(t("arm.resting"));
    await expect(arm(page)).toHaveAttribute("data-state", "words");
  });
}
