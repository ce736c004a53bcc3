// A scene of thousands of objects, of which a few are within reach.

import { mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { answer } from "../lib/person.mjs";
import { nextDecision, question, transcript, type } from "../lib/talk.mjs";
import { expect, test } from "../lib/test.mjs";

const COUNT = 3_000;
const DIGITS = ["zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine"];
const TRAITS = ["red", "blue", "green"].map((colour) => ({
  name: colour,
  values: DIGITS.map((digit) => `${colour}${digit}`),
}));

/** The values of an object: a digit of its number for each trait, and which thousand it is of. */
const valuesOf = (n) => ({
  ...Object.fromEntries(
    TRAITS.map(({ name, values }, k) => [name, values[Math.floor(n / 10 ** k) % 10]]),
  ),
  room: ["cellar", "attic", "garage"][Math.floor(n / 1000)],
});

function sceneFile() {
  const value = (values) => `[${values.map((one) => JSON.stringify(one)).join(", ")}]`;
  const traits = [...TRAITS, { name: "room", values: ["cellar", "attic", "garage"] }];
  const attribute = ({ name, values }) =>
    `[[attributes]]\nname = "${name}"\nvalues = ${value(values)}`;
  const object = (_, n) => {
    const values = Object.entries(valuesOf(n)).map(([k, v]) => `${k} = "${v}"`);
    const at = `xyz = [0.65, ${n === 0 ? 0.2 : -0.2}, -0.125]`;
    const place =
      n < 2 ? `\n${at}\nsize = [0.08, 0.08, 0.06]\ngrasp_width = 0.004\nform = "hollow"` : "";
    return `[[objects]]\nname = "p${n}"\nattributes = { ${values.join(", ")} }${place}`;
  };
  const parts = ['name = "store"\nnoun = "part"', ...traits.map(attribute)];
  const file = join(mkdtempSync(join(tmpdir(), "wo-scene-")), "store.toml");
  writeFileSync(file, [...parts, ...Array.from({ length: COUNT }, object)].join("\n"));
  return file;
}

test.use({ settings: [`group.scene=${sceneFile()}`] });

/** Asks for the object of that number and answers truthfully until the interaction has ended. */
async function askFor(page, group, n) {
  const wanted = { name: `p${n}`, attributes: valuesOf(n) };
  const before = (await group.state()).dialogue.last?.interaction ?? 0;
  await type(page, `get me the ${wanted.attributes.red} part`);
  for (let answered = 0; ; ) {
    const { prompt, text, question: asked, decision } = await nextDecision(group, answered);
    if (decision !== "ask") break;
    // An answer is to the question that the page shows.
    await expect(question(page)).toContainText(text);
    await type(page, answer(asked, wanted));
    answered = prompt;
  }
  await expect
    .poll(async () => (await group.state()).dialogue.last?.interaction ?? 0)
    .toBeGreaterThan(before);
  return (await group.state()).dialogue.last;
}

test("among thousands of objects the page lists the likely ones and says how many others there are", async ({
  console: page,
  group,
}) => {
  await expect(page.locator(".card")).toHaveCount(12);
  await expect(page.locator("button.more")).toContainText("2,988");
  const frames = [];
  page.on("websocket", (socket) =>
    socket.on("framereceived", ({ payload }) => frames.push(payload)),
  );
  await page.reload();
  await expect(page.locator(".card")).toHaveCount(12);
  const first = frames.find((frame) => String(frame).includes('"t":"state"'));
  expect(String(first).length, "bytes of the first view").toBeLessThan(60_000);

  expect(await askFor(page, group, 1)).toMatchObject({ object: "p1", outcome: "delivered" });
  const far = await askFor(page, group, 2_345);
  expect(far).toMatchObject({ object: "p2345", outcome: "failed" });
  await expect(transcript(page)).toContainText("I cannot reach the");
  await expect(question(page)).toBeVisible();
});
