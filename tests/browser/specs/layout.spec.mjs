// What is seen without scrolling.

import { expectAccessible } from "../lib/axe.mjs";
import { t } from "../lib/strings.mjs";
import { expectDelivered, nextDecision, question, transcript, type } from "../lib/talk.mjs";
import { expect, test } from "../lib/test.mjs";

const whole = { ratio: 0.99 };

/** Nothing of what must be seen is cut off or covered. */
async function expectWhole(page) {
  await expect(page.getByRole("meter")).toHaveCount(6);
  for (const meter of await page.getByRole("meter").all())
    await expect(meter).toBeInViewport(whole);
  await expect(page.locator(".health > summary")).toBeInViewport(whole);
  await expect(page.getByRole("button", { name: t("stop.stop") })).toBeInViewport(whole);
  const covered = () =>
    page.evaluate(() => {
      const at = (node) => {
        const { left, top, width, height } = node.getBoundingClientRect();
        return document.elementFromPoint(left + width / 2, top + height / 2);
      };
      const seen = (node) => node.contains(at(node)) || node.closest(".card")?.contains(at(node));
      const nodes = [...document.querySelectorAll(".card .bar, .health > summary, #stop")];
      return nodes.filter((node) => !seen(node)).map((node) => node.outerHTML);
    });
  await expect.poll(covered).toEqual([]);
}

for (const colorScheme of /** @type {const} */ (["light", "dark"])) {
  test.describe(`a low window, ${colorScheme}`, () => {
    test.use({ viewport: { width: 1280, height: 720 }, colorScheme });

    test("shows health, stop and all objects", async ({ console: page, group }) => {
      await expect(page.getByText(t("control.mine"))).toBeVisible();
      await expectWhole(page);
      await type(page, "get me the bowl");
      const { text } = await nextDecision(group, 0);
      await expect(question(page)).toContainText(text);
      await expectWhole(page);
      await type(page, "the clear bowl");
      await expectDelivered(page, group, "clear");
      await expectWhole(page);
      await expectAccessible(page);
    });
  });
}

test.describe("a phone", () => {
  test.use({ viewport: { width: 390, height: 844 } });

  test("shows the belief, the stop and the question once", async ({ console: page, group }) => {
    await type(page, "get me the bowl");
    const { text } = await nextDecision(group, 0);
    await expect(question(page)).toContainText(text);
    await expect(question(page).getByRole("listitem")).toHaveCount(6);
    await expect(question(page).getByRole("list")).toBeInViewport(whole);
    await expect(transcript(page).getByText(text)).toBeHidden();
    await expect(page.getByRole("button", { name: t("stop.stop") })).toBeInViewport(whole);
    await expectAccessible(page);
  });
});
