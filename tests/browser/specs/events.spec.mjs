// What happens besides the conversation is in the details.

import { expectAccessible } from "../lib/axe.mjs";
import { t } from "../lib/strings.mjs";
import { stopByKey, transcript, type } from "../lib/talk.mjs";
import { expect, test } from "../lib/test.mjs";

test("restarts and stops are events, not lines of the conversation", async ({
  console: page,
  group,
}) => {
  await expect(page.getByText(t("control.mine"))).toBeVisible();
  await page.locator(".health > summary").click();
  const events = page.getByRole("list", { name: t("events.heading") });
  await group.killAndWait("grounding");
  await expect(events).toContainText(t("note.service_back", { service: "grounding" }));
  await stopByKey(page);
  await expect(events).toContainText(t("note.stopped"));
  await type(page, "hello");
  await expect(transcript(page)).not.toContainText("grounding");
  await expect(transcript(page)).not.toContainText("stopped");
  await expectAccessible(page);
});
