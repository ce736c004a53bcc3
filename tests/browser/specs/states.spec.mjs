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
    why: [/Why this question[\s\S]*Of the 6 objects that it may be, yes speaks for 3, no for 3\./],
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
    why: [t("why.sure", { object: NEW, share: "96%" }), OLD_ORDER],
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
    // The arm goes on with the order that it has.
    list: [t("mark.picking")],
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

async function show(page, state, lines = []) {
  const fed = await Fed.open(page);
  fed.state(STATES[state]);
  fed.lines(lines);
  await expect(page.locator(":root[data-ready]")).toBeAttached();
  await expect(page.locator(".voice-talk")).toBeAttached();
  await expect(page.locator("#arm .arm-caption")).not.toBeEmpty();
  if (state === "disconnected") await fed.cut();
  return fed;
}

/** A line of everybody who has any. */
const LINES = ["person", "robot", "unmeant"].map((who, n) => ({ id: n + 1, who, text: "a bowl" }));

for (const [state, views] of Object.entries(SAYS)) {
  test(`${state}: every view says so`, async ({ page }) => {
    await show(page, state, LINES);
    await expect(page.locator(".lines .clock")).toHaveCount(LINES.length);
    for (const [view, [says, never]] of Object.entries(views)) {
      const node = page.locator(VIEWS[view]);
      await expect.soft(node, view).toContainText(says, { timeout: 8_000, useInnerText: true });
      if (never)
        await expect
          .soft(node, view)
          .not.toContainText(never, { timeout: 1_000, useInnerText: true });
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

/** A phone, the same on its side, a tablet, a desk, a desk at 200 %. */
const SIZES = [
  [360, 740],
  [740, 360],
  [820, 1180],
  [1280, 800],
  [640, 400],
];

/** What is wider than the window, outside of it, or under STOP. */
const misplaced = () => {
  const of = (selector) => document.querySelector(selector)?.getBoundingClientRect();
  const [stop, question] = [of("#stop"), of(".question-words")];
  const isOut = ({ left, top, right, bottom }) =>
    left < 0 || top < 0 || right > innerWidth || bottom > innerHeight;
  const covers = question.bottom > stop.top && question.right > stop.left;
  const isWide = document.documentElement.scrollWidth > innerWidth;
  const [sign, control] = [of(".turn"), of(".control-text")];
  const words = document.querySelector(".turn-words");
  // The sign holds its words, and nothing lies on it.
  const isCut = words.scrollWidth > words.clientWidth;
  const isTight = isCut || (sign.right > control.left && sign.bottom > control.top);
  return { isWide, isTight, stop: isOut(stop), question: isOut(question), covers };
};

for (const state of ["asking", "stopped", "disconnected"]) {
  test(`${state}: question and STOP are seen at every size without scrolling`, async ({ page }) => {
    await show(page, state);
    await expect(page.locator("#question .question-words")).not.toBeEmpty();
    const right = { isWide: false, isTight: false, stop: false, question: false, covers: false };
    for (const [width, height] of SIZES) {
      await page.setViewportSize({ width, height });
      await expect.poll(() => page.evaluate(misplaced), `${width}×${height}`).toEqual(right);
    }
  });
}

test("STOP is the second stop of Tab; the question and a stop are announced", async ({ page }) => {
  const fed = await show(page, "idle");
  await page.keyboard.press("Tab");
  await page.keyboard.press("Tab");
  await expect(page.locator("#stop")).toBeFocused();
  fed.lines([{ id: 1, who: "person", text: "get me the bowl" }]);
  await expect(page.getByRole("log")).toContainText("get me the bowl");
  fed.lines([{ id: 2, who: "robot", text: "Is it white?", said: [5, 1] }]);
  await expect(page.locator("#polite[aria-live=polite]")).toHaveText("Is it white?");
  fed.state(STATES.stopped);
  const alert = page.getByRole("alert").filter({ hasText: t("alarm.stopped") });
  await expect(alert).toBeAttached();
});

test("a note ends with the state that it is about", async ({ page }) => {
  const fed = await show(page, "held");
  fed.answers.say = { waits_for: "policy is held by the operator" };
  await page.locator("#say-text").fill("the clear bowl");
  await page.keyboard.press("Enter");
  await expect(page.locator("#say-note")).toContainText("policy is held");
  fed.state(STATES.idle);
  await expect(page.locator("#say-note")).toBeEmpty();
});

test("who is in control has a name, and is there", async ({ page }) => {
  const fed = await show(page, "idle");
  const { control } = STATES.idle;
  const cases = [
    [{ name: "Ann" }, t("control.theirs", { name: "Ann" })],
    [{ name: "" }, t("control.theirs", { name: t("control.someone") })],
    [{ name: null, away: true }, t("control.away", { name: t("control.someone") })],
  ];
  for (const [other, words] of cases) {
    fed.state({ control: { ...control, operator: "v2", ...other } });
    await expect(page.locator(".control-who")).toHaveText(words);
  }
});
