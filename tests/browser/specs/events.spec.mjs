// What happens besides the conversation is in the details; a stop is part of the conversation.

import { expectAccessible } from "../lib/axe.mjs";
import { t } from "../lib/strings.mjs";
import { stopByKey, transcript, type } from "../lib/talk.mjs";
import { expect, test } from "../lib/test.mjs";

test("restarts are events, stops are lines of the conversation", async ({
  console: page,
  group,
}) => {
  await expect(page.getByText(t("control.mine"))).toBeVisible();
  await page.locator(".health > summary").click();
  const events = page.getByRole("list", { name: t("events.heading") });
  await group.killAndWait("grounding");
  await expect(events).toContainText(t("note.service_back", { service: "grounding" }));
  await stopByKey(page);
  await expect(transcript(page)).toContainText(t("note.stopped"));
  await expect(events).not.toContainText(t("note.stopped"));
  await type(page, "hello");
  await expect(transcript(page)).not.toContainText("grounding");
  await expectAccessible(page);
});
