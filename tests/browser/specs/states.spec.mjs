// What every view says in each state, and what it must not say: a table, over sections that the test sends.

import { expectAccessible } from "../lib/axe.mjs";
import { Fed } from "../lib/fed.mjs";
import { NEW, OLD, STATES } from "../lib/states.mjs";
import { t } from "../lib/strings.mjs";
import { expect, test } from "../lib/test.mjs";

/** The views, by name. */
const VIEWS = {
  sign: "#turn",
  headline: "#question",
  why: "#why",
  list: "#cards",
  picture: "#arm",
  talk: "#say",
  voice: "#voice",
  health: ".health > summary",
  stop: "#stop",
  resume: "#resume",
  control: "#control",
  alert: "#alarm",
};

const PROMISE = /I will get|being fetched|Fetch the clear|About to|On the way/;
const OLD_ORDER = new RegExp(`${OLD}|Handed over the big`);
const policy = t("question.held.words", { service: "policy", state: t("service.held") });
const offline = t("alarm.offline");
/** A view's words in a state: what it says, then what it must not say. */
const SAYS = {
  idle: {
    sign: [t("turn.idle")],
    headline: [t("question.idle", { noun: "bowl" }), /Delivered/],
    why: [t("why.idle"), PROMISE],
    list: ["17%", PROMISE],
    picture: ["Handed over the big metallic bowl"],
    health: ["ready"],
    stop: ["STOP", t("stop.stopped")],
    control: [t("control.mine")],
  },
  asking: {
    sign: [t("turn.asked")],
    headline: ["Is it white?"],
    why: [t("why.question")],
    list: ["17%", PROMISE],
    picture: [t("arm.resting"), OLD_ORDER],
    health: ["ready"],
  },
  decided: {
    headline: [`I will get the ${NEW}`],
    why: [t("action.pick", { object: NEW }), OLD_ORDER],
    list: ["96%", /being fetched/],
    picture: [t("arm.resting"), OLD_ORDER],
  },
  fetching: {
    sign: [t("turn.moving")],
    headline: [`I will get the ${NEW}`],
    why: [t("action.pick", { object: NEW }), OLD_ORDER],
    list: [t("mark.picking")],
    picture: [`On the way to the ${NEW}`, OLD_ORDER],
  },
  stopped: {
    sign: [t("turn.stopped")],
    headline: [t("turn.stopped"), PROMISE],
    why: [t("why.stopped")],
    list: [t("mark.halted"), PROMISE],
    picture: [t("arm.stopped"), PROMISE],
    stop: [t("stop.stopped")],
    resume: [t("resume.words")],
    alert: [t("alarm.stopped")],
  },
  "stopped at a question": {
    sign: [t("turn.stopped")],
    headline: [/Stopped[\s\S]*Is it white\?/],
    why: [t("why.stopped")],
    list: ["17%", PROMISE],
    picture: [t("arm.stopped"), OLD_ORDER],
    resume: [t("resume.words")],
  },
  held: {
    sign: [t("turn.down"), /starting or has failed/],
    headline: [policy, PROMISE],
    why: [policy, PROMISE],
    list: ["96%", /being fetched/],
    health: ["Held or switched off: policy"],
    voice: [t("voice.talk.held.more"), /no connection/],
  },
  disconnected: {
    sign: [t("turn.offline")],
    headline: [t("turn.offline"), PROMISE],
    why: [t("question.disconnected"), PROMISE],
    list: ["96%", PROMISE],
    picture: [t("arm.disconnected"), PROMISE],
    voice: [t("voice.talk.off.more")],
    health: [t("health.unknown"), /ready/],
    stop: [t("stop.down")],
    control: [t("control.offline"), /in control/],
    alert: [offline],
  },
  delivered: {
    headline: [/Handed over\s*Clear bowl/],
    why: [t("why.idle"), PROMISE],
    list: ["17%", PROMISE],
    picture: [`Handed over the ${NEW}`, OLD_ORDER],
  },
};

/** Views that are not shown in any other state. */
const HIDDEN_UNLESS = { resume: /stopped/, alert: /stopped|disconnected/ };

async function show(page, state) {
  const fed = await Fed.open(page);
  fed.state(STATES[state]);
  await expect(page.locator(":root[data-ready]")).toBeAttached();
  await expect(page.locator(".voice-talk")).toBeAttached();
  await expect(page.locator("#arm .arm-caption")).not.toBeEmpty();
  if (state === "disconnected") await fed.cut();
  return fed;
}

for (const [state, views] of Object.entries(SAYS)) {
  test(`${state}: every view says so`, async ({ page }) => {
    await show(page, state);
    for (const [view, [says, never]] of Object.entries(views)) {
      const node = page.locator(VIEWS[view]);
      await expect.soft(node, view).toContainText(says, { timeout: 8_000 });
      if (never) await expect.soft(node, view).not.toContainText(never, { timeout: 1_000 });
    }
    for (const [view, only] of Object.entries(HIDDEN_UNLESS)) {
      if (only.test(state)) continue;
      await expect.soft(page.locator(`${VIEWS[view]}:not([hidden]) *:visible`)).toHaveCount(0);
    }
    const isHealthy = !["disconnected"].includes(state);
    if (!isHealthy) await expect.soft(page.locator("[data-state=good]")).toHaveCount(0);
    for (const colorScheme of /** @type {const} */ (["light", "dark"])) {
      await page.emulateMedia({ colorScheme });
      await expectAccessible(page);
    }
  });
}
