// A person who speaks: what programs say, played into the page's microphone.

import { execFile } from "node:child_process";
import { mkdtemp, readFile, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { promisify } from "node:util";
import { until } from "./until.mjs";

const run = promisify(execFile);
const HEADER = 44;

/** Settings: every sentence takes as long as its audio, without playing it on this machine. */
export const ALOUD = ["speech.voice=espeak-ng", 'speech.player=["none"]'];

/**
 * Waits until the robot can hear.
 * @param {import("./group.mjs").Group} group
 */
export const hears = (group) =>
  until("the recogniser", async () => (await group.state()).hearing?.recogniser === "ready");

/**
 * Name of the robot's latest line: a question that is asked again is to be answered again.
 * @param {{speaking?: {prompt: number, presentation: number}|null}} state
 */
export const saidLast = ({ speaking }) =>
  speaking ? `${speaking.prompt}-${speaking.presentation}` : "";

/**
 * Says a text with flite, whose voice is cut from recordings of a person.
 * @param {string} text
 * @returns {Promise<Buffer>} samples of 16 bits, one channel, 16 kHz
 */
export async function say(text) {
  const folder = await mkdtemp(join(tmpdir(), "say"));
  try {
    const file = join(folder, "said.wav");
    await run("flite", ["-voice", "slt", "-t", text, "-o", file]);
    return (await readFile(file)).subarray(HEADER);
  } finally {
    await rm(folder, { recursive: true });
  }
}

/** @param {number} seconds @returns {Buffer} silence as `say` gives it */
export function quiet(seconds) {
  return Buffer.alloc(2 * Math.round(seconds * 16_000));
}

/**
 * Writes samples as a WAV file.
 * @param {string} path
 * @param {Buffer} samples
 */
export async function writeWav(path, samples) {
  const header = Buffer.alloc(HEADER);
  header.write("RIFF", 0);
  header.writeUInt32LE(36 + samples.length, 4);
  header.write("WAVEfmt ", 8);
  header.writeUInt32LE(16, 16);
  header.writeUInt16LE(1, 20);
  header.writeUInt16LE(1, 22);
  header.writeUInt32LE(16_000, 24);
  header.writeUInt32LE(32_000, 28);
  header.writeUInt16LE(2, 32);
  header.writeUInt16LE(16, 34);
  header.write("data", 36);
  header.writeUInt32LE(samples.length, 40);
  await writeFile(path, Buffer.concat([header, samples]));
}

/**
 * Gives a page a microphone into which tests speak when they like. To be called before it is opened.
 * @param {import("@playwright/test").Page} page
 */
export function giveMicrophone(page) {
  return page.addInitScript(() => {
    let context;
    let room;
    navigator.mediaDevices.getUserMedia = async () => {
      context = new AudioContext();
      room = context.createMediaStreamDestination();
      await context.resume();
      return room.stream;
    };
    window.speakIntoMicrophone = async (base64) => {
      const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
      const samples = new Int16Array(bytes.buffer);
      const buffer = context.createBuffer(1, samples.length, 16_000);
      buffer.copyToChannel(
        Float32Array.from(samples, (sample) => sample / 32_768),
        0,
      );
      const source = new AudioBufferSourceNode(context, { buffer });
      source.connect(room);
      source.start();
      await new Promise((resolve) => {
        source.onended = resolve;
      });
    };
  });
}

/**
 * Speaks into the microphone of a page that has opened it.
 * @param {import("@playwright/test").Page} page
 * @param {string} text
 */
export async function speak(page, text) {
  const samples = await say(text);
  await page.evaluate((sound) => window.speakIntoMicrophone(sound), samples.toString("base64"));
}

/**
 * Holds the talk button, speaks, and lets go.
 * @param {import("@playwright/test").Page} page
 * @param {string} text
 */
export async function holdAndSpeak(page, text) {
  const button = page.locator(".voice-talk");
  await button.hover();
  await page.mouse.down();
  await page.waitForFunction(() => {
    const { state } = document.querySelector(".voice-talk").dataset;
    return state === "talking" || state === "hearing";
  });
  await speak(page, text);
  await page.mouse.up();
}
