// The page behind a gateway: below a robot's folder, for people with rights of their own.

import { drawn } from "../lib/arm.mjs";
import { expectAccessible } from "../lib/axe.mjs";
import { WITH_PICTURE } from "../lib/chromium.mjs";
import { Gateway } from "../lib/gateway.mjs";
import { t } from "../lib/strings.mjs";
import { nextDecision, question, stopByKey, type } from "../lib/talk.mjs";
import { test as base, expect } from "../lib/test.mjs";
import { until } from "../lib/until.mjs";

const test = base.extend({
  gateway: async ({ group }, use) => {
    const gateway = await Gateway.up(group);
    await use(gateway);
    await gateway.down();
  },
});
test.use(WITH_PICTURE);

test("an operator finds the robot in the list, and its page works in its folder", async ({
  page,
  group,
  gateway,
  watched,
}) => {
  void watched;
  await page.goto(await gateway.add("ann", "--operator", group.name));
  const row = page.getByRole("row", { name: group.name });
  await expect(row).toContainText("ready");
  await expect(row).toContainText("operator");
  await expectAccessible(page);
  await page.getByRole("link", { name: group.name }).click();
  await expect(page).toHaveURL(`${gateway.url}${group.name}/`);
  await expect(page.getByText(t("control.mine"))).toBeAttached();
  await drawn(page);
  await type(page, "get me the bowl");
  const { text } = await nextDecision(group, 0);
  await expect(question(page)).toContainText(text);
  await stopByKey(page);
  await until("the stop in the audit", async () =>
    (await gateway.audit()).some(({ what, outcome }) => what === "stop" && outcome === "done"),
  );
  const said = (await gateway.audit()).find(({ what }) => what === "say");
  expect(said).toMatchObject({ person: "ann", robot: group.name, text: "get me the bowl" });
  await page.getByRole("button", { name: t("history.show") }).click();
  const sheet = page.getByRole("dialog", { name: t("history.title") });
  await expect(sheet).toContainText("get me the bowl");
});

test.describe("a viewer", () => {
  test.use({ provoked: ["404", "403"] });

  test("sees the robot and cannot stop it; other robots stay closed", async ({
    page,
    group,
    gateway,
    watched,
  }) => {
    void watched;
    const link = await gateway.add("bob", "--viewer", group.name);
    await page.goto(`${gateway.url}${group.name}/`);
    await expect(page).toHaveURL(`${gateway.url}_/login`);
    await expectAccessible(page);
    await page.getByLabel("Your secret").fill("0123456789abcdef");
    await page.getByRole("button", { name: "Log in" }).click();
    await expect(page.getByRole("alert")).toBeVisible();
    await page.goto(link);
    await page.getByRole("link", { name: group.name }).click();
    await expect(page.locator("#cards")).toContainText("bowl");
    await until("the refused stop in the audit", async () => {
      await page.keyboard.press("Escape");
      await page.keyboard.press("Escape");
      const audit = await gateway.audit();
      return audit.some(({ what, outcome }) => what === "stop" && outcome === "refused");
    });
    expect((await group.state()).arm.stopped).toBe(false);
    const other = await page.goto(`${gateway.url}another/`);
    expect(other?.status()).toBe(403);
    await expect(page.getByText("has no right to a robot another")).toBeVisible();
  });
});
