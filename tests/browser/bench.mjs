// What a person at the page waits for, in a real browser: from the end of speech to the first sound of
// the robot's answer, and from the arm's state to its picture. Talks with a real group, in real time.
//
//   WHICHONE_BUILD=release node tests/browser/bench.mjs [DIALOGUES]

import { mkdir, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { chromium } from "@playwright/test";
import { drawnFinely } from "./lib/arm.mjs";
import { CHROMIUM, CHROMIUM_FLAGS } from "./lib/chromium.mjs";
import { Group } from "./lib/group.mjs";
import { answer } from "./lib/person.mjs";
import { TARGET } from "./lib/program.mjs";
import { until } from "./lib/until.mjs";
import { ALOUD, giveMicrophone, hears, holdAndSpeak, saidLast } from "./lib/voice.mjs";

const DIALOGUES = Number(process.argv[2] ?? 12);
const BOWLS = ["white", "white2", "white3", "metal", "metal2", "clear"];
/** Moves of one dialogue; a person who is misheard again and again gives up. */
const MOVES_MAX = 10;
/** Time after which a person says it again, longer than a fetch: it was not taken for a request. */
const SILENCE_MS = 15_000;

const group = await Group.up([...ALOUD, "arm.time_scale=1"]);
const browser = await chromium.launch({
  executablePath: CHROMIUM,
  args: [...CHROMIUM_FLAGS, "--autoplay-policy=no-user-gesture-required"],
});

/** The robot's next question after `before`, the end of the interaction, or nothing for a long time. */
const next = (before, interaction) => {
  const look = async () => {
    const state = await group.state();
    const { dialogue, turn } = state;
    const said = saidLast(state);
    if ((dialogue.last?.interaction ?? 0) > interaction) return { ...dialogue, said };
    return turn.state === "asked" && said !== before && { ...dialogue, said };
  };
  return until("the robot's move", look, SILENCE_MS).catch(() => undefined);
};

/** One spoken dialogue about an object; whether the right one came. */
async function converse(page, name) {
  const before = await group.state();
  const wanted = before.scene.objects.find((object) => object.name === name);
  const interaction = before.dialogue.last?.interaction ?? 0;
  let [said, words] = [saidLast(before), "get me the bowl"];
  for (let move = 0; move < MOVES_MAX; move += 1) {
    await holdAndSpeak(page, words);
    const dialogue = await next(said, interaction);
    if (!dialogue) continue;
    const { last, question } = dialogue;
    if ((last?.interaction ?? 0) > interaction) return last.object === name;
    [said, words] = [dialogue.said, answer(question, wanted)];
  }
  return false;
}

const quantile = (sorted, share) =>
  sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))];

function row(what, values) {
  const sorted = [...values].sort((a, b) => a - b);
  const [p50, p95, p99] = [0.5, 0.95, 0.99].map((share) => quantile(sorted, share));
  return { what, p50, p95, p99, count: sorted.length };
}

async function measure() {
  const page = await browser.newPage({ viewport: { width: 1440, height: 900 } });
  await giveMicrophone(page);
  await page.goto(group.link());
  await hears(group);
  await drawnFinely(page);
  let right = 0;
  for (let n = 0; n < DIALOGUES; n += 1) {
    right += (await converse(page, BOWLS[n % BOWLS.length])) ? 1 : 0;
  }
  const replies = await page.evaluate(() =>
    performance.getEntriesByName("voice:reply").map(({ duration }) => duration),
  );
  const arm = await page.evaluate(() => document.querySelector("#arm").armView.stats());
  const { latency } = await group.state();
  return { right, replies, arm, latency };
}

try {
  const { right, replies, arm, latency } = await measure();
  const rows = [
    row("end of speech to the first sound of the answer, ms", replies),
    { what: "arm's state to its picture, ms", ...arm.state_to_picture_ms, count: arm.count },
    { what: "between two frames while the arm moves, ms", ...arm.frame_ms, count: arm.count },
  ];
  const lines = rows.map(({ what, p50, p95, p99, count }) =>
    [what, p50?.toFixed(1), p95?.toFixed(1) ?? "", p99?.toFixed(1), count].join(" | "),
  );
  const head = `console in Chromium: ${right} of ${DIALOGUES} spoken dialogues right`;
  const report = [head, "", "| what | p50 | p95 | p99 | count |", "|---|---|---|---|---|"];
  report.push(...lines.map((line) => `| ${line} |`));
  await mkdir(join(TARGET, "bench"), { recursive: true });
  const data = { right, dialogues: DIALOGUES, rows, arm, latency, replies };
  await writeFile(join(TARGET, "bench/console.json"), `${JSON.stringify(data, null, 2)}\n`);
  console.log(report.join("\n"));
} finally {
  await browser.close();
  await group.down();
}
