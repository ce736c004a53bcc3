// The list of objects: the operator says one by a press on it.

import { expectAccessible } from "../lib/axe.mjs";
import { t } from "../lib/strings.mjs";
import { expectDelivered, transcript } from "../lib/talk.mjs";
import { expect, test } from "../lib/test.mjs";

const sayings = (page, words) =>
  page.getByRole("button", { name: t("objects.say", { words }), exact: true });

test("an object is fetched at a press on it; viewers have nothing to press", async ({
  console: page,
  group,
  browser,
}) => {
  await expect(sayings(page, "the clear bowl")).toBeVisible();
  const context = await browser.newContext();
  const viewer = await context.newPage();
  await viewer.goto(group.link());
  await expect(viewer.getByRole("meter")).toHaveCount(6);
  await expect(sayings(viewer, "the clear bowl")).toBeHidden();

  await sayings(page, "the clear bowl").click();
  await expect(transcript(page)).toContainText("the clear bowl");
  await expectDelivered(page, group, "clear");
  await expectAccessible(page);
  await context.close();
});
