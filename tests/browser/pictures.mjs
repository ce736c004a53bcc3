// Takes the pictures of docs/pictures/console-*.png: the console as people see it, from a real group.
//
//   node tests/browser/pictures.mjs [FOLDER]

import { join } from "node:path";
import { chromium } from "@playwright/test";
import { CHROMIUM, CHROMIUM_FLAGS } from "./lib/chromium.mjs";
import { Group } from "./lib/group.mjs";
import { ROOT } from "./lib/program.mjs";
import { t } from "./lib/strings.mjs";
import { answerUntilPicked, nextDecision, type } from "./lib/talk.mjs";
import { until } from "./lib/until.mjs";

const FOLDER = process.argv[2] ?? join(ROOT, "docs/pictures");
const DESKTOP = { width: 1440, height: 900 };
const PHONE = { width: 390, height: 844 };
const STUDY = ["study.enabled=true", "study.title=Asking for bowls"];

const browser = await chromium.launch({ executablePath: CHROMIUM, args: CHROMIUM_FLAGS });
const group = await Group.up(["arm.time_scale=1", ...STUDY], "kitchen");

/** Opens a page of the console in a browser of this size and theme. */
async function open(path, viewport, colorScheme) {
  const context = await browser.newContext({ viewport, colorScheme, deviceScaleFactor: 1 });
  const page = await context.newPage();
  await page.goto(new URL(path, group.url).href);
  return page;
}

/** Takes a picture once the fonts are there and nothing glides any more. */
async function take(page, name) {
  await page.evaluate(async () => {
    await document.fonts.ready;
    await Promise.all(document.getAnimations().map((animation) => animation.finished));
  });
  await page.screenshot({ path: join(FOLDER, `console-${name}.png`) });
}

const drawn = (page) => page.locator("#arm[data-state=ready]").waitFor({ timeout: 60_000 });
const armIs = (phase) => until(phase, async () => (await group.state()).arm.phase === phase);

/** A dialogue: its question on each size and theme, the arm on its way, the stop. */
async function dialogue() {
  const page = await open("/", DESKTOP, "light");
  await page.getByText(t("control.mine")).waitFor();
  await drawn(page);
  const phone = await open("/", PHONE, "dark");
  await phone.getByText(t("question.idle", { noun: "bowl" })).waitFor();
  await type(page, "get me the big bowl");
  await nextDecision(group, 0);
  await take(page, "asks");
  await take(phone, "phone");
  await page.emulateMedia({ colorScheme: "dark" });
  await answerUntilPicked(page, group, "clear");
  await armIs("holding");
  await take(page, "fetches");
  await page.emulateMedia({ colorScheme: "light" });
  await page.keyboard.press("Escape");
  await page.getByRole("button", { name: t("stop.resume") }).waitFor();
  await take(page, "stopped");
  await group.must("resume-motion");
  await until("the hand-over", async () => (await group.state()).dialogue.last);
  await page.context().close();
  await phone.context().close();
}

/** A participant of a study, up to the first dialogue. */
async function study() {
  const page = await open("/study", DESKTOP, "light");
  const next = async (name) => page.getByRole("button", { name: t(name) }).click();
  await next("study.begin");
  await page.locator('body[data-screen="instructions"]').waitFor();
  await next("study.continue");
  await page.locator("#start:not(:disabled)").waitFor();
  await take(page, "study");
  await page.context().close();
}

try {
  await dialogue();
  await study();
} finally {
  await browser.close();
  await group.down();
}
