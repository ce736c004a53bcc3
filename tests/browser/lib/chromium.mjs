// The browser that tests are run in: the system's own Chromium.

import { existsSync } from "node:fs";
import { tmpdir } from "node:os";

/** Where Chromium is; the first of its usual places, or what WHICHONE_CHROMIUM says. Windows cost time. */
export const CHROMIUM = [
  process.env.WHICHONE_CHROMIUM,
  "/usr/bin/chromium-headless-shell",
  "/usr/bin/chromium",
  "/usr/bin/chromium-browser",
  "/usr/bin/google-chrome",
].find((path) => path && existsSync(path));

/** Flags for a machine without a screen or a way out. */
const FLAGS = [
  "--no-sandbox",
  "--no-first-run",
  "--disable-quic",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-sync",
  "--disable-dev-shm-usage",
];

/** Flags with which the processor draws the picture, for want of a graphics card. */
export const CHROMIUM_FLAGS = [...FLAGS, "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];

/**
 * Options of a browser with these flags.
 * @param {string[]} args
 */
export const launchOptions = (args) => ({
  executablePath: CHROMIUM,
  args,
  env: { ...process.env, TMPDIR: tmpdir() },
});

/** Flags with which words replace the picture, whose drawing takes most of the processor. */
export const PLAIN_FLAGS = [...FLAGS, "--disable-gpu", "--disable-software-rasterizer"];

/** A browser that draws the picture: for the tests of it. */
export const WITH_PICTURE = { launchOptions: launchOptions(CHROMIUM_FLAGS) };

/**
 * Flags of a microphone that plays a WAV file once, and is granted without a question.
 * @param {string} wav absolute path
 */
export const microphoneOf = (wav) => [
  "--use-fake-device-for-media-stream",
  "--use-fake-ui-for-media-stream",
  `--use-file-for-fake-audio-capture=${wav}%noloop`,
];
