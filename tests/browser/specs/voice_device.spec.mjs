// A device of the browser's own: Chromium's false microphone, which plays a file.

import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { CHROMIUM_FLAGS, launchOptions, microphoneOf } from "../lib/chromium.mjs";
import { expect, test } from "../lib/test.mjs";
import { ALOUD, hears, quiet, say, writeWav } from "../lib/voice.mjs";

const folder = mkdtempSync(join(tmpdir(), "wo-voice-"));
process.on("exit", () => rmSync(folder, { recursive: true, force: true }));
const wav = join(folder, "microphone.wav");

test.use({ settings: ALOUD });
const args = [...CHROMIUM_FLAGS, ...microphoneOf(wav)];
test.use({ launchOptions: launchOptions(args) });

test("hands-free speech is recognised with interim results", async ({ page, group }) => {
  const request = await say("get me the small white bowl");
  await writeWav(wav, Buffer.concat([quiet(1), request, quiet(3)]));
  await page.goto(group.link());
  await hears(group);
  await page.locator("#transcript .partial").waitFor({ state: "attached" });
  await page.evaluate(() => {
    window.partials = [];
    const words = document.querySelector("#transcript .partial");
    const look = () => words.hidden || window.partials.push(words.textContent);
    new MutationObserver(look).observe(words, {
      attributes: true,
      characterData: true,
      childList: true,
      subtree: true,
    });
  });
  const handsFree = page.getByRole("button", { name: /hands-free/i });
  await handsFree.click();
  await expect(handsFree).toHaveAttribute("aria-pressed", "true");
  await expect(page.locator("#transcript")).toContainText(/(small|white)[^?]*bowl/, {
    timeout: 40_000,
  });
  const partials = await page.evaluate(() => window.partials);
  expect(partials.some((text) => /get|bring|small|white|bowl/.test(text))).toBe(true);
  await handsFree.click();
  await expect(page.locator(".voice-open")).toBeVisible();
  await page.locator(".voice-open button").click();
  await expect(page.locator(".voice-open")).toBeHidden();
});
