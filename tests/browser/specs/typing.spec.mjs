// A whole interaction by typing.

import { t } from "../lib/strings.mjs";
import { answerUntilPicked, expectDelivered, question, transcript, type } from "../lib/talk.mjs";
import { expect, test } from "../lib/test.mjs";

test("a person gets the right bowl by typing", async ({ console: page, group }) => {
  await type(page, "get me the bowl");
  const questions = await answerUntilPicked(page, group, "metal2");
  await expectDelivered(page, group, "metal2");
  expect(questions).toBeLessThanOrEqual(4);
  await expect(transcript(page).getByText(t("line.understood")).first()).toBeVisible();
});

test("the belief's bars follow the words", async ({ console: page, group }) => {
  const bars = page.getByRole("meter");
  await expect(bars).toHaveCount(6);
  await type(page, "the big bowl");
  await expect(question(page)).not.toContainText(t("question.idle", { noun: "bowl" }));
  const { scene, dialogue } = await group.state();
  const { label } = scene.objects.find((object) => object.name === "clear");
  const bar = page.getByRole("meter", { name: label });
  const percent = (100 * dialogue.belief.clear).toFixed(1);
  await expect(bar).toHaveAttribute("aria-valuenow", percent);
});

test.describe("words that are refused", () => {
  test.use({ settings: ["speech.utterance_bytes_max=40"] });

  test("are explained and can be mended", async ({ console: page }) => {
    const text = "get me the bowl that my grandmother gave to my aunt";
    const field = page.getByRole("textbox", { name: t("say.label") });
    await field.fill(text);
    await page.keyboard.press("Enter");
    await expect(page.getByRole("status").filter({ hasText: "40" })).toBeVisible();
    await expect(field).toHaveValue(text);
  });
});
