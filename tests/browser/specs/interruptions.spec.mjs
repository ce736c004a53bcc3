// What a page outlives.

import { t } from "../lib/strings.mjs";
import {
  answerUntilPicked,
  expectDelivered,
  nextDecision,
  question,
  transcript,
  type,
} from "../lib/talk.mjs";
import { expect, test } from "../lib/test.mjs";

// The browser itself reports a socket that cannot be opened.
const LINK_LOST = ["WebSocket connection", "ERR_CONNECTION_REFUSED"];

test("a reload in the middle of a dialogue keeps its state", async ({ console: page, group }) => {
  await type(page, "get me the bowl");
  const { text } = await nextDecision(group, 0);
  await page.reload();
  await expect(transcript(page)).toContainText("get me the bowl");
  await expect(question(page)).toContainText(text);
  await expect(page.getByText(t("control.mine"))).toBeVisible();
  await answerUntilPicked(page, group, "clear");
  await expectDelivered(page, group, "clear");
});

test("the services are killed in the middle", async ({ console: page, group }) => {
  await type(page, "get me the bowl");
  await nextDecision(group, 0);
  for (const service of ["speech", "grounding", "policy", "arm"]) await group.killAndWait(service);
  await answerUntilPicked(page, group, "white");
  await expectDelivered(page, group, "white");
});

test.describe("the console itself", () => {
  test.use({ provoked: LINK_LOST });

  test("is killed in the middle", async ({ console: page, group }) => {
    await type(page, "get me the bowl");
    await nextDecision(group, 0);
    await group.killAndWait("console");
    await expect(page.getByText(t("control.mine"))).toBeVisible();
    await answerUntilPicked(page, group, "white2");
    await expectDelivered(page, group, "white2");
  });
});
