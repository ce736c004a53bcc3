// Past interactions: the list, one of them step by step, files that are shared, and thousands of them.

import { spawn } from "node:child_process";
import { mkdir, readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { expectAccessible } from "../lib/axe.mjs";
import { program } from "../lib/program.mjs";
import { t } from "../lib/strings.mjs";
import { answerUntilPicked, type } from "../lib/talk.mjs";
import { expect, test } from "../lib/test.mjs";
import { until } from "../lib/until.mjs";

// The console is killed, and the group goes down.
test.use({ provoked: ["WebSocket connection", "ERR_CONNECTION_REFUSED"] });

const sheetOf = (page) => page.getByRole("dialog", { name: t("history.title") });
const show = (page) => page.getByRole("button", { name: t("history.show") }).click();
const currentOf = (root) => root.locator(".story [aria-current=step]");

/** One dialogue about the third white bowl; its label and the number of questions. */
async function dialogue(page, group) {
  await type(page, "get me the bowl");
  const questions = await answerUntilPicked(page, group, "white3");
  await until("the hand-over", async () => (await group.state()).dialogue.last);
  const { scene } = await group.state();
  const { label } = scene.objects.find(({ name }) => name === "white3");
  return { label, questions };
}

/** Walks through the only interaction by keys and buttons. */
async function expectWalk(page, { label, questions }) {
  const sheet = sheetOf(page);
  await expect(sheet.locator(".past-list")).toContainText(
    t("history.delivered", { object: label }),
  );
  await expect(sheet.locator(".past-list")).toContainText("get me the bowl");
  await expect(sheet.locator(".past-reach")).toContainText("1 ");
  const moments = sheet.locator(".story > li");
  await expect(moments.first()).toContainText("get me the bowl");
  const heard = sheet.locator('.story-one[data-actor="person"]');
  await expect(heard).toHaveCount(questions + 1);
  await expect(heard.nth(1)).toContainText(t("history.answers"));
  await expect(heard.nth(1)).toContainText("%");
  const current = currentOf(sheet);
  await expect(current).toContainText("get me the bowl");
  await page.keyboard.press("ArrowRight");
  await expect(current).not.toContainText("get me the bowl");
  const back = sheet.getByRole("button", { name: t("history.before"), exact: true });
  await back.click();
  await expect(current).toContainText("get me the bowl");
  await expect(back).toBeDisabled();
  await expect(sheet.locator(".why-list li").first()).toBeVisible();
  await page.keyboard.press("End");
  await expect(sheet.locator(".past-bars [data-best]")).toContainText(label);
  for (const phase of ["accepted", "moving", "closing", "holding"]) {
    const words = t(`history.arm.${phase}`, { object: label });
    await expect(moments.filter({ hasText: words })).not.toHaveCount(0);
  }
  await expect(moments.filter({ hasText: t("history.delivered", { object: label }) })).toHaveCount(
    1,
  );
  await expect(sheet.getByRole("status").last()).toContainText(label);
  await expectAccessible(page);
}

test("a past interaction is walked through, after a kill of the console and a restart of the group, too", async ({
  console: page,
  group,
}) => {
  test.slow();
  const known = await dialogue(page, group);
  await show(page);
  await expectWalk(page, known);
  expect(new URL(page.url()).hash).toBe("#history=1");
  await page.keyboard.press("Escape");
  await expect(sheetOf(page)).toBeHidden();
  await expect.poll(() => new URL(page.url()).hash).toBe("");
  await group.killAndWait("console");
  await page.reload();
  await show(page);
  await expectWalk(page, known);
  await group.again();
  await page.goto(`${group.link("/")}#history=1`);
  await expectWalk(page, known);
});

test.describe("on a phone", () => {
  test.use({ viewport: { width: 390, height: 700 } });

  test("the stop is reached while the history is open", async ({ console: page, group }) => {
    await show(page);
    const sheet = sheetOf(page);
    await expect(sheet).toBeVisible();
    const stop = sheet.locator("#stop");
    await expect(stop).toBeInViewport({ ratio: 1 });
    await stop.click();
    await until("the stop", async () => (await group.state()).arm?.stopped);
    await expect(sheet).toBeVisible();
    await expect(stop).toHaveAttribute("data-state", "stopped");
    await expectAccessible(page);
    await sheet.getByRole("button", { name: t("history.close") }).click();
    await expect(sheet).toBeHidden();
    await expect(page.locator("#actions #stop")).toBeInViewport();
  });
});

test("an interaction is saved as a file and opened in a page of its own, with a group and without", async ({
  console: page,
  group,
}, info) => {
  const { label } = await dialogue(page, group);
  await show(page);
  const saving = page.waitForEvent("download");
  await sheetOf(page)
    .getByRole("button", { name: t("history.save") })
    .click();
  const file = info.outputPath("interaction.json");
  await (await saving).saveAs(file);
  const saved = JSON.parse(await readFile(file, "utf8"));
  expect(saved.format).toBe("whichone.interaction/1");
  expect(saved.group).toBe(group.name);
  const title = page.getByRole("heading", { name: t("history.delivered", { object: label }) });

  await page.goto(new URL("/history", group.url).href);
  await page.locator("#file").setInputFiles(file);
  await expect(title).toBeVisible();
  await expect(page.locator(".story > li").first()).toContainText("get me the bowl");
  await page.keyboard.press("End");
  await expect(currentOf(page)).not.toContainText("get me the bowl");
  await expectAccessible(page);
  const other = info.outputPath("other.json");
  await writeFile(other, '{"format":"whichone.interaction/1","moments":[{}]}');
  await page.locator("#file").setInputFiles(other);
  await expect(page.getByRole("status").first()).toContainText("other.json");
  await expect(title).toBeHidden();

  const viewer = spawn(program("whichone"), ["console", "--view", file]);
  try {
    const link = await new Promise((resolve) => {
      viewer.stdout.once("data", (text) => resolve(String(text).trim()));
    });
    await page.goto(link);
    await expect(title).toBeVisible();
    const refused = await fetch(new URL("/api/history", link));
    expect(refused.status).toBe(404);
  } finally {
    viewer.kill("SIGINT");
  }
});

test("ten thousand interactions are listed as far as they are looked at", async ({
  console: page,
  group,
}) => {
  const TOTAL = 10_000;
  const one = (interaction) => ({
    interaction,
    unix_ms: 1_700_000_000_000 + interaction * 600_000,
    whole: true,
    objects: [{ name: "white", label: "white bowl" }],
    moments: [
      {
        after_ms: 0,
        event: {
          type: "heard",
          utterance: interaction,
          text: `request ${interaction}`,
          source: "text",
          confidence: 1,
          snr_db: null,
          readings: [],
          answers: [],
        },
        thought: null,
      },
    ],
    left_out: 0,
    end: { outcome: "not_here", object: null, questions: 2, duration_s: 9.5 },
  });
  const folder = join(group.home, group.name, "journal", "history");
  await mkdir(folder, { recursive: true });
  for (let first = 1; first <= TOTAL; first += 1_000) {
    const lines = Array.from({ length: 1_000 }, (_, n) => `${JSON.stringify(one(first + n))}\n`);
    await writeFile(join(folder, `${String(first).padStart(20, "0")}.jsonl`), lines.join(""));
  }
  await group.must("restart", "console");
  await page.reload();
  await show(page);
  const sheet = sheetOf(page);
  const rows = sheet.locator(".past-one");
  await expect(rows.first()).toContainText(`request ${TOTAL}`);
  await expect(sheet.locator(".past-reach")).toContainText("10,000");
  expect(await rows.count()).toBeLessThan(200);
  const before = await rows.count();
  await sheet.locator(".past-nav").evaluate((list) => list.scrollTo(0, list.scrollHeight));
  await expect.poll(() => rows.count()).toBeGreaterThan(before);
  await expect(sheet.locator(".story > li").first()).toContainText(`request ${TOTAL}`);
  // Any of them has an address, also one that the list has not come to.
  await page.goto(`${page.url().split("#")[0]}#history=17`);
  await expect(sheet.locator(".story > li").first()).toContainText("request 17");
});
