import { defineConfig } from "@playwright/test";
import { launchOptions, PLAIN_FLAGS } from "./lib/chromium.mjs";
import { TARGET } from "./lib/program.mjs";

// Each test starts a group and a browser of its own; two at a time fill two cores. The deadlines are for
// machines without a graphics card that are busy besides: they end what hangs, nothing else.
export default defineConfig({
  testDir: "specs",
  outputDir: `${TARGET}/browser/results`,
  timeout: 240_000,
  expect: { timeout: 40_000 },
  fullyParallel: true,
  workers: Number(process.env.WHICHONE_BROWSER_WORKERS ?? 2),
  retries: 0,
  forbidOnly: true,
  reporter: [["list"]],
  use: {
    browserName: "chromium",
    headless: true,
    locale: "en-US",
    // A trace costs a fifth of a test's processor time: the second try, alone, keeps one.
    trace: "off",
    screenshot: "only-on-failure",
    launchOptions: launchOptions(PLAIN_FLAGS),
  },
});
