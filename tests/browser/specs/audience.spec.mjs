// The page for an audience.

import { drawn } from "../lib/arm.mjs";
import { expectAccessible } from "../lib/axe.mjs";
import { WITH_PICTURE } from "../lib/chromium.mjs";
import { nextDecision, type } from "../lib/talk.mjs";
import { expect, test } from "../lib/test.mjs";

test.use(WITH_PICTURE);

for (const viewport of [
  { width: 1920, height: 1080 },
  { width: 1024, height: 768 },
]) {
  test(`the question is read at five metres at ${viewport.width} × ${viewport.height}`, async ({
    console: page,
    group,
    browser,
  }) => {
    const context = await browser.newContext({ viewport });
    const audience = await context.newPage();
    await audience.goto(group.link("/audience"));
    await type(page, "get me the bowl");
    const { text } = await nextDecision(group, 0);
    const sentence = audience.locator("#sentence");
    await expect(sentence).toHaveText(text);
    const size = await sentence.evaluate((node) => parseFloat(getComputedStyle(node).fontSize));
    expect(size).toBeGreaterThanOrEqual(0.05 * viewport.height);
    await expect(audience.locator("#heard")).toContainText("get me the bowl");
    await expect(audience.locator("#bars li").first()).toContainText("%");
    await drawn(audience);

    await expect(audience.locator(":is(button, input, a, select):visible")).toHaveCount(0);
    await expectAccessible(audience);
    const [wide, high] = await audience.evaluate(() => {
      const { scrollWidth, scrollHeight } = document.documentElement;
      return [scrollWidth, scrollHeight];
    });
    expect([wide, high], "all of it is seen").toEqual([viewport.width, viewport.height]);
    await context.close();
  });
}

test("an audience's page never gets control, even where nobody has it", async ({
  page,
  group,
  watched,
}) => {
  void watched;
  await page.goto(group.link("/audience"));
  await expect(page.locator("#sentence")).not.toBeEmpty();
  await expect.poll(async () => (await group.state()).control.viewers).toBe(1);
  expect((await group.state()).control.operator).toBeNull();
});
