// Takes docs/pictures/console-*.png and study-*.png: the console as people see it, from real groups.
//
//   node tests/browser/pictures.mjs [FOLDER [dialogue|editor|study]]

import { join } from "node:path";
import { chromium } from "@playwright/test";
import { drawnFinely } from "./lib/arm.mjs";
import { CHROMIUM, CHROMIUM_FLAGS } from "./lib/chromium.mjs";
import { Group } from "./lib/group.mjs";
import { finish, press, rate, request, screen } from "./lib/participant.mjs";
import { ROOT } from "./lib/program.mjs";
import { checked, openEditor, sheet, thing } from "./lib/scene.mjs";
import { t } from "./lib/strings.mjs";
import { answerUntilPicked, nextDecision, type } from "./lib/talk.mjs";
import { until } from "./lib/until.mjs";

const FOLDER = process.argv[2] ?? join(ROOT, "docs/pictures");
/** The part to take; all without one. */
const ONLY = process.argv[3];
const DESKTOP = { width: 1440, height: 900 };
const PHONE = { width: 390, height: 844 };
const POLICIES = ["lookahead", "information-seeking"];
/** Frames without an animation after which a page has come to rest. */
const FRAMES_OF_REST = 20;
/** Those of a participant, with each policy. */
const INTERACTIONS = 2;
const STUDY = [
  "study.enabled=true",
  "study.title=Asking for bowls",
  `study.policies=${JSON.stringify(POLICIES)}`,
  `study.interactions=${INTERACTIONS}`,
];

const browser = await chromium.launch({ executablePath: CHROMIUM, args: CHROMIUM_FLAGS });
/** @type {Group} */
let group;

/** Opens a page of the console in a browser of this size and theme. */
async function open(path, viewport, colorScheme) {
  const context = await browser.newContext({ viewport, colorScheme, deviceScaleFactor: 1 });
  const page = await context.newPage();
  await page.goto(group.link(path));
  return page;
}

/** Takes a picture once the fonts are there and nothing has glided for some frames. */
async function take(page, name) {
  await page.evaluate(async (framesOfRest) => {
    await document.fonts.ready;
    for (let rest = 0; rest < framesOfRest; rest += 1) {
      await new Promise(requestAnimationFrame);
      const runs = document.getAnimations().some(({ playState }) => playState === "running");
      if (runs) rest = 0;
    }
  }, FRAMES_OF_REST);
  await page.screenshot({ path: join(FOLDER, `${name}.png`) });
}

const armIs = (phase) => until(phase, async () => (await group.state()).arm.phase === phase);

/** A dialogue: its question on each size and theme, the arm on its way, the stop. */
async function dialogue() {
  const page = await open("/", DESKTOP, "light");
  await page.getByText(t("control.mine")).waitFor();
  await drawnFinely(page);
  const phone = await open("/", PHONE, "dark");
  await phone.getByText(t("question.idle", { noun: "bowl" })).waitFor();
  await type(page, "get me the big bowl");
  await nextDecision(group, 0);
  await drawnFinely(page);
  await take(page, "console-asks");
  await take(phone, "console-phone");
  await page.emulateMedia({ colorScheme: "dark" });
  await answerUntilPicked(page, group, "clear");
  await armIs("holding");
  await take(page, "console-fetches");
  await page.emulateMedia({ colorScheme: "light" });
  await page.keyboard.press("Escape");
  await page.getByRole("button", { name: t("resume.words"), exact: true }).waitFor();
  await drawnFinely(page);
  await take(page, "console-stopped");
  await group.release();
  await until("the hand-over", async () => (await group.state()).dialogue.last);
  await page.getByRole("button", { name: t("history.show") }).click();
  await page.locator(".story-one").nth(1).click();
  await take(page, "console-history");
  await page.keyboard.press("Escape");
  await page.context().close();
  await phone.context().close();
}

/** The scene editor with an object chosen and its reach. */
async function editor() {
  const page = await open("/", DESKTOP, "light");
  await page.getByText(t("control.mine")).waitFor();
  await openEditor(page);
  await thing(page, "clear").click();
  await checked(page);
  await sheet(page).and(page.locator("[data-reach=known]")).waitFor({ timeout: 120_000 });
  await take(page, "console-scene");
  await page.context().close();
}

/** The participants of a study, one of them with a phone, and what is found out by them. */
async function study() {
  const people = [
    { viewport: DESKTOP, theme: "light", mark: 4, picture: "console-study" },
    { viewport: PHONE, theme: "dark", mark: 3, picture: "study-phone" },
    { viewport: DESKTOP, theme: "light", mark: 2, picture: null },
  ];
  for (const { viewport, theme, mark, picture } of people) {
    const page = await open("/study", viewport, theme);
    await takePart(page, mark, picture);
    await page.context().close();
  }
  const page = await open("/study", DESKTOP, "light");
  await press(page, "study.begin");
  const results = await open("/results", DESKTOP, "light");
  await results.getByRole("img", { name: t("study.picture.success") }).waitFor();
  await take(results, "study-results");
}

/** From the welcome to the thanks; the picture is that of the first card, or of the first question. */
async function takePart(page, mark, picture) {
  await press(page, "study.begin");
  await screen(page, "instructions");
  await press(page, "study.continue");
  for (let left = INTERACTIONS * POLICIES.length; left > 0; left -= 1) {
    const first = left === INTERACTIONS * POLICIES.length ? picture : null;
    await page.locator("#start:not(:disabled)").waitFor({ timeout: 60_000 });
    if (first === "console-study") await take(page, first);
    const desired = await request(page);
    if (first === "study-phone") {
      await nextDecision(group, 0);
      await take(page, first);
    }
    await finish(page, group, desired);
    await press(page, left > 1 ? "study.next" : "study.continue");
  }
  await screen(page, "questionnaire");
  await rate(page, mark);
  await press(page, "study.send");
  await screen(page, "thanks");
}

async function inGroup(settings, show) {
  if (![undefined, show.name].includes(ONLY)) return;
  group = await Group.up(settings, "kitchen");
  try {
    await show();
  } finally {
    await group.down();
  }
}

try {
  await inGroup(["arm.time_scale=1"], dialogue);
  await inGroup([], editor);
  await inGroup(STUDY, study);
} finally {
  await browser.close();
}
