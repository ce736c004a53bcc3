// The page for everybody: axe-core finds nothing, in each theme, size and state.

import { expectAccessible } from "../lib/axe.mjs";
import { t } from "../lib/strings.mjs";
import { nextDecision, question, stopByKey, type } from "../lib/talk.mjs";
import { expect, test } from "../lib/test.mjs";

const SIZES = { desktop: { width: 1440, height: 900 }, phone: { width: 390, height: 844 } };
const THEMES = /** @type {const} */ (["light", "dark"]);

/** Nothing is wrong with what is shown, in either theme. */
async function expectAccessibleInThemes(page) {
  for (const colorScheme of THEMES) {
    await page.emulateMedia({ colorScheme });
    await expectAccessible(page);
  }
}

for (const [size, viewport] of Object.entries(SIZES)) {
  test.describe(size, () => {
    test.use({ viewport, provoked: ["WebSocket connection", "ERR_CONNECTION_REFUSED", "404"] });

    test("a dialogue, a stop and a lost link", async ({ console: page, group }) => {
      await expect(page.getByText(t("control.mine"))).toBeAttached();
      await expectAccessibleInThemes(page);

      await type(page, "get me the bowl");
      const { text } = await nextDecision(group, 0);
      await expect(question(page)).toContainText(text);
      await expectAccessibleInThemes(page);

      await stopByKey(page);
      await expectAccessibleInThemes(page);

      await group.must("stop", "console");
      await expect(page.getByText(t("alarm.offline"))).toBeVisible();
      await expectAccessibleInThemes(page);
    });

    test("help, and the pages around it", async ({ console: page, group }) => {
      await page.getByRole("button", { name: t("help.open"), exact: true }).click();
      const help = page.getByRole("dialog", { name: t("help.title") });
      await expect(help).toContainText(t("help.say.correct.words"));
      await expectAccessibleInThemes(page);
      for (const path of ["/nowhere", "/login"]) {
        await page.goto(group.link(path));
        await expectAccessibleInThemes(page);
      }
    });
  });
}

test("the whole page can be reached and used by keyboard", async ({ console: page }) => {
  await expect(page.getByText(t("control.mine"))).toBeAttached();
  await page.keyboard.press("Tab");
  await expect(page.getByRole("link", { name: t("skip") })).toBeFocused();
  await page.keyboard.press("Enter");
  await page.keyboard.type("the clear bowl");
  await page.keyboard.press("Enter");
  await expect(page.getByRole("log", { name: t("talk.log") })).toContainText("the clear bowl");
});

test("nothing is cut off at 320 pixels", async ({ console: page }) => {
  await page.setViewportSize({ width: 320, height: 640 });
  const wide = () => page.evaluate(() => document.documentElement.scrollWidth);
  await expect.poll(wide).toBeLessThanOrEqual(320);
});

test("nobody gets in without the token, and the owner by one click", async ({ page, group }) => {
  await page.goto(group.url);
  await expect(page.getByRole("heading", { name: t("login.title") })).toBeVisible();
  await expectAccessible(page);
  await page.getByLabel(t("login.token")).fill("not-the-token");
  await page.getByRole("button", { name: t("login.enter") }).click();
  await expect(page.getByText(t("login.wrong"))).toBeVisible();

  // From another site, too: a link in a mail or in a terminal that is a page.
  await page.goto("data:text/html,<title>a mail</title>");
  await page.evaluate((link) => location.assign(link), group.link());
  await expect(page.getByText(t("control.mine"))).toBeAttached();
  expect(page.url(), "the token is not in the address").toBe(group.url);
  const [cookie] = await page.context().cookies(group.url);
  expect(cookie).toMatchObject({ httpOnly: true, sameSite: "Strict" });
  expect(cookie.value).not.toContain(group.token);
});
