// What can be said to the robot at a press: examples, answers, and what to say of a hand-over.

import { expectAccessible } from "../lib/axe.mjs";
import { t } from "../lib/strings.mjs";
import { expectDelivered, nextDecision, offer, question, transcript, type } from "../lib/talk.mjs";
import { expect, test } from "../lib/test.mjs";
import { until } from "../lib/until.mjs";

const handedOver = (page) => question(page).getByText(t("delivery.kicker"), { exact: true });

test.describe("a question of yes or no", () => {
  test.use({ settings: ["dialogue.choice_questions=false"] });

  test("an example is a request; answers are said as if typed", async ({
    console: page,
    group,
  }) => {
    await expectAccessible(page);
    await offer(page, "“get me the bowl”").click();
    await expect(transcript(page)).toContainText("get me the bowl");
    const first = await nextDecision(group, 0);
    for (const name of [t("answer.yes"), t("answer.no"), t("answer.any")]) {
      await expect(offer(page, name)).toBeVisible();
    }
    await offer(page, t("answer.unknown")).click();
    await expect(transcript(page)).toContainText("I don't know");
    const second = await nextDecision(group, first.prompt);
    expect(second.question).not.toEqual(first.question);
    await page.keyboard.press(t("keys.no_key"));
    const third = await nextDecision(group, second.prompt);
    expect(third.applied).toBeGreaterThan(second.applied);
  });
});

test("a choice has its values to press", async ({ console: page, group }) => {
  await type(page, "get me the bowl");
  const { question: asked, prompt } = await nextDecision(group, 0);
  expect(asked.type).toBe("choice");
  const { scene } = await group.state();
  const { values } = scene.attributes.find(({ name }) => name === asked.attribute);
  const options = values.filter(({ name }) => asked.values.includes(name));
  for (const { spoken } of options) await expect(offer(page, spoken)).toBeVisible();
  const isAll = options.length === values.length;
  await expect(offer(page, t("answer.none"))).toBeVisible({ visible: !isAll });
  await offer(page, options[0].spoken).click();
  await expect(transcript(page)).toContainText(options[0].spoken);
  await nextDecision(group, prompt);
});

test.describe("a question with several values", () => {
  test.use({
    settings: [
      "dialogue.open_questions=true",
      "dialogue.attribute_questions=false",
      "dialogue.choice_questions=false",
    ],
  });

  test("has each of them to press", async ({ console: page, group }) => {
    await type(page, "get me the bowl");
    const { question: asked } = await nextDecision(group, 0);
    expect(asked.type).toBe("which");
    const { scene } = await group.state();
    const { values } = scene.attributes.find(({ name }) => name === asked.attribute);
    for (const { spoken } of values) await expect(offer(page, spoken)).toBeVisible();
    await expectAccessible(page);
    await offer(page, values[0].spoken).click();
    await expect(transcript(page)).toContainText(values[0].spoken);
  });
});

test("what was handed over is confirmed, and viewers see it without buttons", async ({
  console: page,
  group,
  browser,
}) => {
  const context = await browser.newContext();
  const viewer = await context.newPage();
  await viewer.goto(group.link());
  await type(page, "the clear bowl");
  await expectDelivered(page, group, "clear");
  await expect(handedOver(page)).toBeVisible();
  await expect(handedOver(viewer)).toBeVisible();
  await expect(offer(viewer, t("delivery.wrong"))).toBeHidden();
  for (const key of ["wrong", "back"]) {
    await expect(offer(page, t(`delivery.${key}`))).toBeVisible();
  }
  await expectAccessible(page);
  await offer(page, t("delivery.right")).click();
  await expect(transcript(page)).toContainText("that's right");
  await expect(handedOver(page)).toBeHidden();
  await expect(question(page)).toContainText(t("question.idle", { noun: "bowl" }));
  await context.close();
});

test("the wrong one is told at a press, and the robot goes on", async ({
  console: page,
  group,
}) => {
  await type(page, "the white bowl in the dishwasher");
  await expectDelivered(page, group, "white");
  await offer(page, t("delivery.wrong")).click();
  await until("the refusal", async () => {
    const { dialogue } = await group.state();
    return dialogue.last.outcome === "refused" && dialogue.interaction > 0;
  });
  await expect(handedOver(page)).toBeHidden();
});

test("what was handed over can be wished back", async ({ console: page, group }) => {
  await type(page, "the clear bowl");
  await expectDelivered(page, group, "clear");
  await offer(page, t("delivery.back")).click();
  await expect(transcript(page)).toContainText("put it back");
  await expect(handedOver(page)).toBeHidden();
});

test.describe("a short time for refusals", () => {
  test.use({ settings: ["dialogue.turns.refusal_s=2.0"] });

  test("ends by itself", async ({ console: page, group }) => {
    await type(page, "the clear bowl");
    await until("the hand-over", async () => (await group.state()).dialogue.last);
    await expect(question(page)).toContainText(t("question.idle", { noun: "bowl" }));
    await expect(handedOver(page)).toBeHidden();
  });
});
