// Talking to the robot through the page, as a person does.

import { answer } from "./person.mjs";
import { expectStopped } from "./resume.mjs";
import { t } from "./strings.mjs";
import { expect } from "./test.mjs";
import { until } from "./until.mjs";

/**
 * Types something and sends it.
 * @param {import("@playwright/test").Page} page
 * @param {string} text
 */
export async function type(page, text) {
  await page.getByRole("textbox", { name: t("say.label") }).fill(text);
  await expect(page.getByRole("button", { name: t("say.send") })).toBeEnabled();
  await page.keyboard.press("Enter");
  await expect(transcript(page)).toContainText(text);
}

/** The dialogue as the page shows it. @param {import("@playwright/test").Page} page */
export const transcript = (page) => page.getByRole("log", { name: t("talk.log") });

/** The robot's present question. @param {import("@playwright/test").Page} page */
export const question = (page) => page.getByRole("region", { name: t("question.heading") });

/**
 * Waits until the robot has asked something that is not yet answered, or has decided.
 * @param {import("./group.mjs").Group} group
 * @param {number} answered the prompt that was answered last
 */
export const nextDecision = (group, answered) =>
  until("the robot's next decision", async () => {
    const { dialogue, turn } = await group.state();
    const asks = dialogue.decision === "ask" && dialogue.prompt !== answered;
    if (asks && turn.state === "asked") return dialogue;
    return dialogue.decision === "pick" || (dialogue.interaction === 0 && answered > 0)
      ? dialogue
      : undefined;
  });

/**
 * Answers the robot's questions truthfully until it fetches something.
 * @param {import("@playwright/test").Page} page
 * @param {import("./group.mjs").Group} group
 * @param {string} name of the wanted object
 * @returns {Promise<number>} how many questions there were
 */
export async function answerUntilPicked(page, group, name) {
  const wanted = (await group.state()).scene.objects.find((object) => object.name === name);
  let answered = 0;
  for (let asked = 0; ; asked += 1) {
    const dialogue = await nextDecision(group, answered);
    if (dialogue.decision !== "ask") return asked;
    await expect(question(page)).toContainText(dialogue.text);
    await type(page, answer(dialogue.question, wanted));
    answered = dialogue.prompt;
  }
}

/**
 * Waits until the page shows that an object was handed over.
 * @param {import("@playwright/test").Page} page
 * @param {import("./group.mjs").Group} group
 * @param {string} name of the wanted object
 */
export async function expectDelivered(page, group, name) {
  const last = await until("the hand-over", async () => (await group.state()).dialogue.last);
  expect(last).toMatchObject({ object: name, outcome: "delivered" });
  await expect(question(page)).toContainText(delivered);
}

/** What the page says of a hand-over, while it can be refused and after. */
const delivered = new RegExp(`${t("delivery.kicker")}|${t("last.delivered.other").split(":")[0]}`);

/**
 * A button that says something to the robot, beside its question.
 * @param {import("@playwright/test").Page} page
 * @param {string} name
 */
export const offer = (page, name) => question(page).getByRole("button", { name, exact: true });

/**
 * Presses Escape twice, and again as a person would, until STOP shows that the arm is stopped: a page that
 * is just being drawn on a slow machine takes the presses for two single ones.
 * @param {import("@playwright/test").Page} page
 */
export async function stopByKey(page) {
  await expect(async () => {
    await page.keyboard.press("Escape");
    await page.keyboard.press("Escape");
    await expectStopped(page, { timeout: 2_000 });
  }).toPass();
}
