// A browser without WebGL: text replaces the drawing of the arm.

import { arm, BROWSERS_BY_THREAD } from "../lib/arm.mjs";
import { CHROMIUM, CHROMIUM_FLAGS } from "../lib/chromium.mjs";
import { t } from "../lib/strings.mjs";
import { expect, test } from "../lib/test.mjs";

const args = CHROMIUM_FLAGS.filter((flag) => !flag.includes("swiftshader"));
args.push("--disable-gpu", "--disable-software-rasterizer");
test.use({ launchOptions: { executablePath: CHROMIUM, args } });

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
