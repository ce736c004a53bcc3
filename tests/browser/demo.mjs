// What the demo weighs, how soon it asks, and pictures of it:
//
//   node tests/browser/demo.mjs [FOLDER]      prints the figures; with a folder, writes the pictures there

import { join } from "node:path";
import { chromium } from "@playwright/test";
import { launchOptions, PLAIN_FLAGS } from "./lib/chromium.mjs";
import { DEMO, MISSING } from "./lib/demo.mjs";
import { serve } from "./lib/static.mjs";

const ROUNDS = 9;
const SIZES = [
  [1280, 800],
  [360, 740],
];

if (MISSING) {
  console.error(MISSING);
  process.exit(1);
}
const server = await serve(DEMO);
const browser = await chromium.launch(launchOptions(PLAIN_FLAGS));

/** Opens the page afresh. */
async function open(options = {}) {
  const context = await browser.newContext({ locale: "en-US", ...options });
  const page = await context.newPage();
  await page.goto(server.url);
  await page.waitForSelector("html[data-ready]");
  return page;
}

const median = (all) => all.sort((a, b) => a - b)[Math.floor(all.length / 2)];

/** Milliseconds from the address to a page that is ready, and from the request to the question that is shown. */
async function times() {
  const page = await open();
  const ready = await page.evaluate(() => performance.now());
  const asked = await page.evaluate(async () => {
    const began = performance.now();
    document.querySelector(".answer[data-kind='example']").click();
    const isAsked = () => document.querySelector(".question[data-kind='ask']");
    while (!isAsked()) await new Promise(requestAnimationFrame);
    return performance.now() - began;
  });
  await page.context().close();
  return { ready, asked };
}

async function pictures(folder) {
  for (const [width, height] of SIZES) {
    for (const colorScheme of ["light", "dark"]) {
      const page = await open({ viewport: { width, height }, colorScheme });
      const shoot = async (name) => {
        await page.waitForTimeout(700);
        const path = join(folder, `demo-${width}-${colorScheme}-${name}.png`);
        await page.screenshot({ path, fullPage: true });
      };
      await shoot("idle");
      await page.locator(".answer[data-kind='example']").first().click();
      await page.waitForSelector(".question[data-kind='ask']");
      await shoot("asks");
      await page.locator("#say-text").fill("the big white one");
      await page.locator("#say-text").press("Enter");
      await page.waitForTimeout(2_500);
      await shoot("fetches");
      await page.waitForSelector(".question[data-kind='delivered']");
      await shoot("delivered");
      await page.context().close();
    }
  }
}

const all = [];
for (let round = 0; round < ROUNDS; round++) all.push(await times());
console.log(
  `ready after ${median(all.map(({ ready }) => ready)).toFixed(0)} ms (median of ${ROUNDS})`,
);
console.log(`request to question ${median(all.map(({ asked }) => asked)).toFixed(0)} ms`);
if (process.argv[2]) await pictures(process.argv[2]);
await browser.close();
await server.close();
