// The motion stop.

import { expectStopped, resume, resumeButton } from "../lib/resume.mjs";
import { t } from "../lib/strings.mjs";
import { answerUntilPicked, expectDelivered, stopByKey, type } from "../lib/talk.mjs";
import { expect, test } from "../lib/test.mjs";

const stopped = async (group) => (await group.state()).arm.stopped;
const stop = (page) => page.getByRole("button", { name: t("stop.stop") });

test.describe("while the arm moves", () => {
  // A pick that lasts long enough to be stopped by a person.
  test.use({ settings: ["arm.time_scale=1"] });

  test("one press stops it, a held Resume lets it go on, and the bowl still comes", async ({
    console: page,
    group,
  }) => {
    await type(page, "get me the clear bowl");
    await answerUntilPicked(page, group, "clear");
    await expect.poll(async () => (await group.state()).arm.moving).toBe(true);
    await page.keyboard.press("Escape");
    await expect.poll(() => stopped(group)).toBe(true);
    await expect(page.getByRole("alert").filter({ hasText: t("alarm.stopped") })).toBeAttached();
    await expect.poll(async () => (await group.state()).arm.moving).toBe(false);

    const button = resumeButton(page);
    await expect(button).toHaveAccessibleDescription(t("resume.hold"));
    await button.click();
    await stop(page).click();
    expect(await stopped(group), "a short press does not move the arm").toBe(true);
    await resume(page, group);
    await expect(button).toBeHidden();
    await expectDelivered(page, group, "clear");
  });
});

test("it works from the text field, by keyboard alone", async ({ console: page, group }) => {
  await page.getByRole("textbox", { name: t("say.label") }).focus();
  await stopByKey(page);
  expect(await stopped(group)).toBe(true);
});

test("it works while the page is busy", async ({ console: page, group }) => {
  await expect(stop(page)).toBeEnabled();
  const box = await stop(page).boundingBox();
  // Work that leaves the page hardly any time, for as long as the test lasts.
  await page.evaluate(() => {
    const spin = () => {
      const end = performance.now() + 150;
      while (performance.now() < end);
      setTimeout(spin, 0);
    };
    spin();
  });
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await expect.poll(() => stopped(group)).toBe(true);
  await page.mouse.up();
});

test("without the arm's service it warns, with the reason, until the arm confirms", async ({
  console: page,
  group,
}) => {
  await group.must("hold", "arm");
  await expect(page.getByText(t("arm.unknown"))).toBeAttached();
  await expect(page.getByText(t("health.off", { names: "arm" }))).toBeAttached();
  const alarm = page
    .getByRole("alert")
    .filter({ hasText: t("alarm.unconfirmed", { why: t("alarm.why.held") }) });
  const pressed = Date.now();
  await stop(page).click();
  await expect(alarm).toBeVisible();
  test.info().annotations.push({ type: "alarm after, ms", description: `${Date.now() - pressed}` });
  await expect(page.getByText(t("stop.unconfirmed"))).toBeVisible();

  // It stays: after a reload, and when the service comes back, until that has confirmed.
  await page.reload();
  await expect(alarm).toBeVisible();
  const release = page.getByRole("button", { name: t("services.act.release", { name: "arm" }) });
  if (!(await release.isVisible())) await page.locator(".health summary").click();
  await release.click();
  await expect(alarm).toBeHidden();
  await expectStopped(page);
});

test.describe("without a connection", () => {
  test.use({ provoked: ["WebSocket connection", "ERR_CONNECTION_REFUSED"] });

  test("nothing looks healthy, and a stop is kept, sent first, and shown with its age", async ({
    page,
    group,
    watched,
  }) => {
    void watched;
    const sockets = [];
    page.on("websocket", (socket) => {
      const sent = [];
      sockets.push(sent);
      socket.on("framesent", ({ payload }) => {
        if (typeof payload === "string") sent.push(JSON.parse(payload));
      });
    });
    await page.goto(group.link());
    await expect(page.getByText(t("control.mine"))).toBeAttached();
    await group.must("hold", "console");
    await expect(page.locator(":root[data-stale]")).toBeAttached();
    await expect(page.getByText(t("health.unknown"))).toBeAttached();
    await expect(page.getByText(t("control.offline"))).toBeAttached();
    await expect(page.locator("[data-state=good]")).toHaveCount(0);
    await expect(page.getByText(t("control.mine"))).toHaveCount(0);

    const before = sockets.length;
    await stop(page).click();
    await expect(page.locator("#stop")).toHaveAttribute("data-state", "unsent");
    await expect(page.getByRole("alert").filter({ hasText: t("alarm.undelivered") })).toBeVisible();
    await page.waitForTimeout(2_500);
    await group.must("release", "console");
    const [first, last] = t("stop.late", { s: "#" }).split("#");
    await expect(page.getByText(new RegExp(`${first}[0-9]+${last}`))).toBeVisible();
    await expect.poll(() => stopped(group)).toBe(true);
    await expectStopped(page);
    await expect(page.locator(":root[data-stale]")).toHaveCount(0);
    const greeted = sockets.slice(before).filter((sent) => sent.length > 0);
    expect(greeted.at(-1).slice(0, 2)).toMatchObject([{ t: "hello" }, { t: "do", do: "stop" }]);
  });

  test("a console that is killed before the arm confirms gets the stop again", async ({
    console: page,
    group,
  }) => {
    await expect(page.getByText(t("control.mine"))).toBeAttached();
    await group.must("hold", "arm");
    await stop(page).click();
    const why = t("alarm.unconfirmed", { why: t("alarm.why.held") });
    await expect(page.getByRole("alert").filter({ hasText: why })).toBeVisible();
    await group.killAndWait("console");
    await group.must("release", "arm");
    await expectStopped(page);
    expect(await stopped(group)).toBe(true);
  });
});

test("it is in every sheet, and no sheet covers it", async ({ console: page, group }) => {
  await expect(page.getByText(t("control.mine"))).toBeAttached();
  for (const key of ["settings.open", "help.open", "scene.show", "history.show"]) {
    await page.getByRole("button", { name: t(key), exact: true }).click();
    const inSheet = page.locator("dialog[open] #stop");
    await expect(inSheet).toBeInViewport({ ratio: 1 });
    await inSheet.click({ trial: true });
    if (key === "help.open") {
      await inSheet.click();
      await expect.poll(() => stopped(group)).toBe(true);
    }
    await page.locator("dialog[open] .help-head button").last().click();
    await expect(page.locator("#actions #stop")).toBeInViewport({ ratio: 1 });
  }
});
