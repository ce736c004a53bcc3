// Two people look at the same robot.

import { t } from "../lib/strings.mjs";
import { answerUntilPicked, expectDelivered, transcript, type } from "../lib/talk.mjs";
import { expect, test } from "../lib/test.mjs";

test("one talks, the other watches, and control is handed over", async ({
  console: first,
  group,
  browser,
}) => {
  await expect(first.getByText(t("control.mine"))).toBeVisible();
  const context = await browser.newContext();
  const second = await context.newPage();
  await second.goto(group.link());
  await expect(second.getByRole("textbox", { name: t("say.label") })).toBeDisabled();

  await expect(second.locator("#turn")).toContainText(t("turn.theirs_idle"));
  await type(first, "get me the bowl");
  await expect(transcript(second)).toContainText("get me the bowl");

  await second.getByRole("button", { name: t("control.ask") }).click();
  await first.getByRole("button", { name: t("control.give") }).click();
  await expect(second.getByText(t("control.mine"))).toBeVisible();
  await expect(first.getByRole("textbox", { name: t("say.label") })).toBeDisabled();

  await answerUntilPicked(second, group, "white3");
  await expectDelivered(second, group, "white3");
  await expectDelivered(first, group, "white3");
  await context.close();
});

test("a viewer without control can stop the robot", async ({ console: first, group, browser }) => {
  await expect(first.getByText(t("control.mine"))).toBeVisible();
  const context = await browser.newContext();
  const second = await context.newPage();
  await second.goto(group.link());
  await second.getByRole("button", { name: t("stop.stop") }).click();
  await expect.poll(async () => (await group.state()).arm.stopped).toBe(true);
  await expect(first.getByRole("alert").filter({ hasText: t("alarm.stopped") })).toBeAttached();
  await context.close();
});

test.describe("where few pages may be open", () => {
  test.use({ settings: ["console.viewers_max=2"] });

  test("an operator gets in, and the idle page says why it has ended", async ({
    console: first,
    group,
    browser,
  }) => {
    const [idle, next] = await Promise.all([browser.newPage(), browser.newPage()]);
    await expect(first.getByText(t("control.mine"))).toBeVisible();
    await idle.goto(group.link());
    await expect(idle.getByRole("button", { name: t("control.ask") })).toBeVisible();
    await next.goto(group.link());
    await expect(idle.getByRole("alert").filter({ hasText: t("alarm.gave_way") })).toBeVisible();
    await next.getByRole("button", { name: t("control.ask") }).click();
    await first.getByRole("button", { name: t("control.give") }).click();
    await expect(next.getByText(t("control.mine"))).toBeVisible();
    await Promise.all([idle.close(), next.close()]);
  });
});
