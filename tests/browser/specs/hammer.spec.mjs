// STOP pressed again and again never releases itself, whatever the rhythm and the key.

import { releaseCounts } from "../lib/group.mjs";
import { resumeButton } from "../lib/resume.mjs";
import { t } from "../lib/strings.mjs";
import { expect, test } from "../lib/test.mjs";

test.use({ hasTouch: true });

/** How many rhythms are tried; the nightly lane tries 60. */
const COUNT = Number(process.env.WHICHONE_RHYTHMS ?? 12);
/** Time between two presses, milliseconds: from 50 ms to 2 s. */
const RHYTHMS = Array.from({ length: COUNT }, (_, n) => Math.round(50 + (n * 1_950) / (COUNT - 1)));
const PRESSES = 5;
/** Rhythms from one release of the arm to the next: Resume then appears while a finger hammers. */
const RELEASE_EVERY = Math.ceil(COUNT / 3);

/** Ways to press: each returns what presses and what lets go. */
const WAYS = {
  mouse: async (page) => {
    await page.mouse.move(...(await middle(page.locator("#stop"))));
    return [() => page.mouse.down(), () => page.mouse.up()];
  },
  touch: async (page) => {
    const [x, y] = await middle(page.locator("#stop"));
    const cdp = await page.context().newCDPSession(page);
    const touch = (type, touchPoints) =>
      cdp.send("Input.dispatchTouchEvent", { type, touchPoints });
    return [() => touch("touchStart", [{ x, y }]), () => touch("touchEnd", [])];
  },
  Enter: (page) => keyOn(page, page.locator("#stop"), "Enter"),
  Space: (page) => keyOn(page, page.locator("#stop"), "Space"),
  Escape: (page) => keyOn(page, page.locator("body"), "Escape"),
};

async function middle(locator) {
  const { x, y, width, height } = await locator.boundingBox();
  return [x + width / 2, y + height / 2];
}

async function keyOn(page, locator, key) {
  await locator.focus();
  return [() => page.keyboard.down(key), () => page.keyboard.up(key)];
}

/** Counts what the page orders. @param {import("@playwright/test").Page} page */
function orders(page) {
  const count = { stop: 0, resume: 0 };
  page.on("websocket", (socket) =>
    socket.on("framesent", ({ payload }) => {
      const verb = typeof payload === "string" ? JSON.parse(payload).do : undefined;
      if (verb in count) count[verb] += 1;
    }),
  );
  return count;
}

/** Starts a page whose clock the test turns. */
async function begin(page, group) {
  const count = orders(page);
  await page.clock.install();
  await page.goto(group.link());
  await expect(page.getByText(t("control.mine"))).toBeAttached();
  await page.clock.pauseAt(Date.now() + 60_000);
  return count;
}

/** Waits until the arm has stopped; slow presses of Escape do not stop an arm at rest. */
async function stop(page, name, resume) {
  if (name === "Escape") await page.locator("#stop").click();
  await expect(resume).toBeVisible();
}

for (const [name, way] of Object.entries(WAYS)) {
  test(`by ${name}`, async ({ page, group, watched }) => {
    void watched;
    const count = await begin(page, group);
    const resume = page.locator("#resume");
    for (const [n, every] of RHYTHMS.entries()) {
      const isFree = n % RELEASE_EVERY === 0;
      if (isFree) {
        await group.release();
        await expect(resume).toBeHidden();
      }
      const before = count.stop;
      const [down, up] = await way(page);
      for (let press = 0; press < PRESSES; press += 1) {
        await down();
        await page.clock.runFor(Math.ceil(every / 2));
        await up();
        await page.clock.runFor(Math.floor(every / 2));
        // Two presses of Escape stop an arm at rest, if they are close.
        if (press === 0 && name === "Escape") await page.keyboard.press("Escape");
        if (press === 1 && isFree) await stop(page, name, resume);
      }
      const least = name === "Escape" ? 0 : PRESSES;
      expect(count.stop - before, `${every} ms: stops`).toBeGreaterThanOrEqual(least);
      expect(count.resume, `${every} ms: releases`).toBe(0);
    }
    expect((await group.state()).arm.stopped).toBe(true);

    // The same page, the same clock: what is held does release.
    await releaseCounts();
    await page.clock.runFor(2_000);
    await page.mouse.move(...(await middle(resumeButton(page))));
    await page.mouse.down();
    await page.clock.runFor(1_500);
    await page.mouse.up();
    await expect.poll(async () => (await group.state()).arm.stopped).toBe(false);
    expect(count.resume).toBe(1);
  });
}

for (const key of ["Enter", "Space"]) {
  test(`Resume is held by ${key}, and neither short presses nor repetitions count`, async ({
    page,
    group,
    watched,
  }) => {
    void watched;
    const count = await begin(page, group);
    await page.locator("#stop").focus();
    await page.keyboard.down(key);
    await expect(page.locator("#resume")).toBeVisible();
    // The key stays down while the focus moves on: its repetitions hold nothing.
    await page.clock.runFor(3_000);
    await resumeButton(page).focus();
    for (let repeat = 0; repeat < 100; repeat += 1) {
      await page.keyboard.down(key);
      await page.clock.runFor(40);
    }
    await page.keyboard.up(key);
    for (const every of RHYTHMS) {
      await page.keyboard.down(key);
      await page.clock.runFor(Math.min(900, every / 2));
      await page.keyboard.up(key);
      await page.clock.runFor(every / 2);
    }
    expect(count.resume).toBe(0);

    // A press of another key in the middle of a hold cancels it.
    await page.clock.runFor(2_000);
    await page.keyboard.down(key);
    await page.clock.runFor(600);
    await page.keyboard.press("Escape");
    await page.clock.runFor(3_000);
    await page.keyboard.up(key);
    expect(count.resume).toBe(0);

    await page.clock.runFor(2_000);
    await page.keyboard.down(key);
    await page.clock.runFor(600);
    await page.keyboard.down(key);
    await page.clock.runFor(900);
    await page.keyboard.up(key);
    await expect.poll(async () => (await group.state()).arm.stopped).toBe(false);
    expect(count.resume).toBe(1);
  });
}
