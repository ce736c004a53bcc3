// A participant takes part, from the welcome to the file that a lab reads; keyboard only.

import { expectAccessible } from "../lib/axe.mjs";
import { finish, press, rate, request, screen } from "../lib/participant.mjs";
import { resume, resumeButton } from "../lib/resume.mjs";
import { t } from "../lib/strings.mjs";
import { expect, test } from "../lib/test.mjs";

test.use({
  settings: ["study.enabled=true", "study.consent=I agree to take part.", "study.title=Bowls"],
});

test("three interactions, a reload, the questionnaire and the export", async ({
  page,
  group,
  watched,
}) => {
  void watched;
  await page.goto(group.link("/study"));
  await press(page, "study.begin");
  await screen(page, "consent");
  await page.getByRole("checkbox", { name: t("study.agree") }).focus();
  await page.keyboard.press("Space");
  await press(page, "study.continue");
  await screen(page, "instructions");
  await expectAccessible(page);
  await press(page, "study.continue");

  const desired = [];
  for (const number of [1, 2, 3]) {
    await expect(page.getByText(t("study.progress", { n: number, total: 3 }))).toBeVisible();
    desired.push(await request(page));
    await finish(page, group, desired.at(-1));
    if (number === 2) await page.reload();
    await press(page, number < 3 ? "study.next" : "study.continue");
  }

  await screen(page, "questionnaire");
  await expectAccessible(page);
  await press(page, "study.send");
  await expect(page.getByText(t("study.missing.other", { n: 4 }))).toBeVisible();
  await rate(page, 4);
  await page.locator(".study-form textarea").fill("=1+1, “fine”");
  await press(page, "study.send");
  await screen(page, "thanks");

  await page.goto(group.link("/results"));
  await expect(page.getByRole("cell", { name: "100%" })).toBeVisible();
  await expect(page.getByRole("img", { name: t("study.picture.success") })).toBeVisible();
  await expectAccessible(page);
  const download = page.waitForEvent("download");
  await page.getByRole("link", { name: t("study.files.interactions") }).click();
  const rows = await read(await (await download).createReadStream());
  expect(rows.map((row) => [row.desired, row.outcome, row.number])).toEqual(
    desired.map((object, n) => [object, "right", String(n + 1)]),
  );
  const report = await group.json("study", "report");
  expect(report.all).toMatchObject({ interactions: 3, success: 1 });
  expect(report.questionnaire[3].mean.mean).toBe(4);
});

test("a stopped robot: the participant calls the experimenter, who resumes", async ({
  page,
  group,
  context,
  watched,
}) => {
  void watched;
  await page.goto(group.link("/study"));
  await press(page, "study.begin");
  await screen(page, "consent");
  await page.getByRole("checkbox", { name: t("study.agree") }).focus();
  await page.keyboard.press("Space");
  await press(page, "study.continue");
  await screen(page, "instructions");
  await press(page, "study.continue");
  await screen(page, "drawn");
  await page.locator("#stop").click();
  await expect(page.getByText(t("study.waits.stopped")).first()).toBeVisible();
  await expect(page.getByRole("alert").filter({ hasText: t("alarm.participant") })).toBeVisible();
  await expect(page.locator("#start")).toBeDisabled();
  await expect(resumeButton(page)).toHaveCount(0);
  await expectAccessible(page);

  const results = await context.newPage();
  await results.goto(group.link("/results"));
  await expect(results.locator("#stop")).toBeVisible();
  await expectAccessible(results);
  await resume(results, group);
  await expect(page.locator("#start")).toBeEnabled();
});

/** The rows of a table without quotes, by column. */
async function read(stream) {
  let text = "";
  for await (const part of stream) text += part;
  const [heads, ...lines] = text.trim().split("\n");
  const names = heads.split(",");
  return lines.map((line) => {
    const cells = line.split(",");
    return Object.fromEntries(names.map((name, n) => [name, cells[n]]));
  });
}

test("a second participant waits, and the first one withdraws", async ({
  page,
  group,
  browser,
  watched,
}) => {
  void watched;
  const place = group.link("/study");
  await page.goto(place);
  await press(page, "study.begin");
  await screen(page, "consent");

  const elsewhere = await browser.newContext({ locale: "en-US" });
  const other = await elsewhere.newPage();
  await other.goto(place);
  await screen(other, "busy");
  await expectAccessible(other);

  await press(page, "study.withdraw");
  await expectAccessible(page);
  await press(page, "study.withdraw.delete");
  await screen(page, "withdrawn");
  await expect(page.getByText(t("study.deleted.more"))).toBeVisible();
  await screen(other, "welcome");
  await elsewhere.close();
});

test.describe("the belief", () => {
  test.use({
    settings: [
      "study.enabled=true",
      "study.show_belief=true",
      "study.consent=I agree to take part.",
    ],
  });

  test("is shown to participants, who can press nothing of it", async ({
    page,
    group,
    watched,
  }) => {
    void watched;
    await page.goto(group.link("/study"));
    await press(page, "study.begin");
    await screen(page, "consent");
    await page.getByRole("checkbox", { name: t("study.agree") }).focus();
    await page.keyboard.press("Space");
    await press(page, "study.continue");
    await screen(page, "instructions");
    await press(page, "study.continue");
    await request(page);
    await expect(page.getByRole("meter")).toHaveCount(6);
    const first = page.getByRole("meter").first();
    await expect
      .poll(async () => Number(await first.getAttribute("aria-valuenow")))
      .toBeGreaterThan(1);
    for (const button of await page.locator(".card-say").all()) await expect(button).toBeHidden();
  });
});
