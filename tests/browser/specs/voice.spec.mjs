// Talking with the robot: through the page's microphone to the recogniser, and its questions back.

import { expectAccessible } from "../lib/axe.mjs";
import { answer } from "../lib/person.mjs";
import { expect, test } from "../lib/test.mjs";
import { until } from "../lib/until.mjs";
import { ALOUD, giveMicrophone, hears, holdAndSpeak, saidLast, speak } from "../lib/voice.mjs";

test.use({ settings: ALOUD });

/** The robot's next act that differs from the previous one. */
const next = (group, before) =>
  until("the robot's move", async () => {
    const state = await group.state();
    const { dialogue, turn } = state;
    const said = saidLast(state);
    if (dialogue.last?.interaction) return { ...dialogue, said };
    const asked = dialogue.decision === "ask" && turn.state === "asked";
    return asked && said !== before && { ...dialogue, said };
  });

test("a spoken request and spoken answers get the right bowl", async ({ page, group, watched }) => {
  void watched;
  await giveMicrophone(page);
  await page.goto(group.link());
  await hears(group);
  await holdAndSpeak(page, "get me the small white bowl");
  const { scene } = await group.state();
  const wanted = scene.objects.find(({ name }) => name === "white2");
  let dialogue = await next(group, "");
  while (!dialogue.last?.interaction) {
    await holdAndSpeak(page, answer(dialogue.question, wanted));
    dialogue = await next(group, dialogue.said);
  }
  expect(dialogue.last).toMatchObject({ object: "white2", outcome: "delivered" });
  const replies = await page.evaluate(() =>
    performance.getEntriesByName("voice:reply").map(({ duration }) => duration),
  );
  expect(replies.length).toBeGreaterThan(0);
  console.log("end of speech to first sound, ms:", replies.map(Math.round).join(" "));
  // A word of it may be misheard; the right bowl came all the same.
  await expect(page.locator("#transcript")).toContainText(/get me .*(small|white)/);
});

test.describe("while the robot speaks at length", () => {
  const words = "Take as long as you like to think about it. ".repeat(6);
  const script = `espeak-ng -s 80 -w "$1" "$0 ${words}"`;
  const voice = JSON.stringify(["sh", "-c", script, "{text}", "{wav}"]);
  test.use({ settings: [...ALOUD, "speech.voice=command", `speech.voice_command=${voice}`] });

  test("who presses silences it here at once, and who speaks breaks its sentence off", async ({
    page,
    group,
    watched,
  }) => {
    void watched;
    await giveMicrophone(page);
    await page.goto(group.link());
    await hears(group);
    await page.locator("#say-text").fill("get me the bowl");
    await page.keyboard.press("Enter");
    const sound = page.getByRole("button", { name: "Hear the robot here" });
    await expect(sound).toHaveAttribute("data-sounding");
    await page.locator(".voice-talk").hover();
    await page.mouse.down();
    await expect(sound).not.toHaveAttribute("data-sounding");
    await expect(page.locator(".voice-talk")).toHaveAttribute("data-state", /talking|hearing/);
    await speak(page, "the small white bowl on the counter");
    await page.mouse.up();
    // Its sound would last more than half a minute.
    await until("the end of the sentence", async () => {
      const { speaking } = await group.state();
      return speaking?.prompt !== 1 || speaking.presentation > 1 || speaking.ended_ms;
    });
  });
});

test("the space bar opens the microphone except while typing", async ({ page, group, watched }) => {
  void watched;
  await giveMicrophone(page);
  await page.goto(group.link());
  await hears(group);
  const button = page.locator(".voice-talk");
  await page.locator("#say-text").focus();
  await page.keyboard.press("Space");
  await expect(button).toHaveAttribute("aria-pressed", "false");
  await page.locator("h1").click();
  await page.keyboard.down("Space");
  await expect(button).toHaveAttribute("data-state", "talking");
  await speak(page, "get me the small white bowl");
  await page.keyboard.up("Space");
  await expect(button).toHaveAttribute("aria-pressed", "false");
  await expect(page.locator("#transcript")).toContainText(/small|white|bowl/);
});

test("an unavailable microphone is reported with help", async ({ page, group, watched }) => {
  void watched;
  await page.addInitScript(() => {
    navigator.mediaDevices.getUserMedia = () =>
      Promise.reject(new DOMException("no", window.fault ?? "NotAllowedError"));
    window.SpeechRecognition = class {
      start() {
        setTimeout(() => {
          this.onerror({ error: "network" });
          this.onend();
        }, 10);
      }
      stop() {}
      abort() {}
    };
  });
  await page.goto(group.link());
  await hears(group);
  const button = page.locator(".voice-talk");
  const fault = page.getByRole("alert").filter({ hasText: "icrophone" });
  await button.click();
  await expect(fault).toContainText("Allow it");
  await page.evaluate(() => {
    window.fault = "NotFoundError";
  });
  await button.click();
  await expect(fault).toContainText("Plug one in");
  await page.getByRole("button", { name: "Settings", exact: true }).click();
  await page.getByRole("radio", { name: /This browser/ }).check();
  await page.keyboard.press("Escape");
  await button.click();
  await expect(page.locator(".voice-fault")).toContainText("over the internet");
});

test("a browser's own words are taken with the time at which they began", async ({
  page,
  group,
  watched,
}) => {
  void watched;
  await page.addInitScript(() => {
    window.SpeechRecognition = class {
      start() {
        const result = Object.assign([{ transcript: "the clear bowl", confidence: 0.9 }], {
          isFinal: true,
        });
        setTimeout(() => this.onspeechstart(), 50);
        setTimeout(() => this.onresult({ resultIndex: 0, results: [result] }), 400);
      }
      stop() {
        setTimeout(() => this.onend(), 10);
      }
      abort() {}
    };
    localStorage.setItem("whichone.voice", JSON.stringify({ engine: "browser" }));
  });
  await page.goto(group.link());
  await page.locator(".voice-talk").click();
  await expect(page.locator("#transcript")).toContainText("the clear bowl");
  await page.locator(".voice-talk").click();
});

test("the robot's voice is switched off and stays off", async ({ page, group, watched }) => {
  void watched;
  await page.goto(group.link());
  const sound = page.getByRole("button", { name: "Hear the robot here" });
  await expect(sound).toHaveAttribute("aria-pressed", "true");
  await sound.click();
  await expect(sound).toHaveAttribute("aria-pressed", "false");
  await page.reload();
  await expect(sound).toHaveAttribute("aria-pressed", "false");
});

test.describe("a robot without a recogniser", () => {
  test.use({ settings: [...ALOUD, "speech.recogniser=none"] });

  test("says what to install", async ({ page, group, watched }) => {
    void watched;
    await page.goto(group.link());
    const button = page.locator(".voice-talk");
    await expect(button).toContainText("No voice input");
    await button.click();
    await expect(page.locator(".voice-fault")).toContainText("libpocketsphinx3");
  });
});

test("its settings are there for everybody", async ({ page, group, watched }) => {
  void watched;
  await page.goto(group.link());
  await page.getByRole("button", { name: "Settings", exact: true }).click();
  await expect(page.getByRole("radio", { name: /^The robot/ })).toBeChecked();
  await expectAccessible(page);
  await page.getByRole("checkbox", { name: /headset/ }).check();
  await page.keyboard.press("Escape");
  await page.reload();
  await page.getByRole("button", { name: "Settings", exact: true }).click();
  await expect(page.getByRole("checkbox", { name: /headset/ })).toBeChecked();
});
