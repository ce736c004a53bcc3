// Past interactions, step by step.

import { expectAccessible } from "../lib/axe.mjs";
import { t } from "../lib/strings.mjs";
import { answerUntilPicked, type } from "../lib/talk.mjs";
import { expect, test } from "../lib/test.mjs";
import { until } from "../lib/until.mjs";

// The console is killed.
test.use({ provoked: ["WebSocket connection", "ERR_CONNECTION_REFUSED"] });

test("a past interaction is walked through by keys and buttons, also after a restart", async ({
  console: page,
  group,
}) => {
  await type(page, "get me the bowl");
  const questions = await answerUntilPicked(page, group, "white3");
  await until("the hand-over", async () => (await group.state()).dialogue.last);
  const { scene } = await group.state();
  const { label } = scene.objects.find(({ name }) => name === "white3");

  const sheet = page.getByRole("dialog", { name: t("history.title") });
  const current = sheet.locator(".timeline [aria-current=step]");
  const expectWalk = async () => {
    await page.getByRole("button", { name: t("history.show") }).click();
    await expect(sheet.locator(".past-list")).toContainText(label);
    await expect(sheet.getByRole("status")).toContainText("get me the bowl");
    const steps = await sheet.locator(".timeline li").count();
    expect(steps).toBeGreaterThan(questions);
    await expect(current).toHaveAccessibleName(t("history.step", { k: 1, of: steps }));
    await page.keyboard.press("ArrowRight");
    await expect(current).toHaveAccessibleName(t("history.step", { k: 2, of: steps }));
    await sheet.getByRole("button", { name: t("history.before"), exact: true }).click();
    await expect(sheet.getByRole("status")).toContainText("get me the bowl");
    await expect(
      sheet.getByRole("button", { name: t("history.before"), exact: true }),
    ).toBeDisabled();
    await page.keyboard.press("End");
    await expect(current).toHaveAccessibleName(t("history.end"));
    await expect(sheet.getByRole("status")).toContainText(
      t("history.delivered", { object: label }),
    );
    await expect(sheet.locator(".past-bars [data-best]")).toContainText(label);
    await expectAccessible(page);
    await page.keyboard.press("Escape");
  };
  await expectWalk();
  await group.killAndWait("console");
  await page.reload();
  await expectWalk();
});
