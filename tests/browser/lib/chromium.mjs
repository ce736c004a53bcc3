// The browser that tests are run in: the system's own Chromium.

import { existsSync } from "node:fs";

/** Where Chromium is; the first of its usual places, or what WHICHONE_CHROMIUM says. */
export const CHROMIUM = [
  process.env.WHICHONE_CHROMIUM,
  "/usr/bin/chromium",
  "/usr/bin/chromium-browser",
  "/usr/bin/google-chrome",
].find((path) => path && existsSync(path));

/** Flags for a machine without a screen, a graphics card, or a way out. */
export const CHROMIUM_FLAGS = [
  "--no-sandbox",
  "--no-first-run",
  "--disable-quic",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-sync",
  "--disable-dev-shm-usage",
  "--use-angle=swiftshader",
  "--enable-unsafe-swiftshader",
];

/**
 * Flags of a microphone that plays a WAV file once, and is granted without a question.
 * @param {string} wav absolute path
 */
export const microphoneOf = (wav) => [
  "--use-fake-device-for-media-stream",
  "--use-fake-ui-for-media-stream",
  `--use-file-for-fake-audio-capture=${wav}%noloop`,
];
