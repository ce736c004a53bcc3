import assert from "node:assert/strict";
import { describe, it } from "node:test";
import { objectWords, shownPrompt, speak } from "../../../services/console/page/js/speak.js";
import { Store } from "../../../services/console/page/js/store.js";

/** A store with sections, and a link that records what is done. */
function page(sections) {
  const store = new Store();
  store.apply(sections);
  const did = [];
  const link = {
    up: async () => {},
    toServer: (ms) => ms + 1_000,
    serverNow: () => 9_000,
    do: async (verb, args) => {
      did.push({ verb, ...args });
      return { seq: 1 };
    },
  };
  return { context: { link, store }, did };
}

const ME = { welcome: { viewer: "v1" }, control: { operator: "v1" } };
const LINES = [
  { id: 1, who: "robot", said: [4, 1] },
  { id: 2, who: "person" },
];

describe("what is said by a press", () => {
  it("carries what the page had shown, and when the person began", async () => {
    const { context, did } = page({ ...ME, lines: LINES, dialogue: { prompt: 5 } });
    await speak("yes", context);
    assert.equal(did.length, 1);
    const { verb, text, source, seen, from } = did[0];
    assert.deepEqual(
      { verb, text, source, seen, from },
      { verb: "say", text: "yes", source: "typed", seen: 5, from: "" },
    );
    await speak("no", context, { began: 500, seen: 4 });
    assert.deepEqual([did[1].seen, did[1].began_ms, did[1].ended_ms], [4, 1_500, 9_000]);
  });

  it("takes control where there is no operator, and only there", async () => {
    const { context, did } = page({ ...ME, control: { operator: null } });
    await speak("the clear bowl", context);
    assert.deepEqual(
      did.map(({ verb }) => verb),
      ["take_control", "say"],
    );
  });

  it("names an object in the robot's own words", () => {
    const label = "white bowl 2";
    assert.equal(objectWords({ label, description: "white bowl" }), "the white bowl");
  });
});

describe("the latest prompt that is shown", () => {
  const of = (sections) => shownPrompt(page(sections).context.store);

  it("is in the conversation or in large type", () => {
    assert.equal(of({}), 0);
    assert.equal(of({ lines: LINES }), 4);
    assert.equal(of({ lines: LINES, dialogue: { prompt: 6 } }), 6);
    assert.equal(of({ lines: LINES, dialogue: { prompt: 0 } }), 4);
  });
});
