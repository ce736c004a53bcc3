import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { describe, it } from "node:test";
import { conversation, events } from "../../../services/console/page/js/model/conversation.js";
import { endWords, noteWords } from "../../../services/console/page/js/model/notes.js";
import { translator } from "../../../services/console/page/js/strings.js";

const robot = (id, prompt, presentation, text) => ({
  id,
  who: "robot",
  said: [prompt, presentation],
  text,
  unix_ms: id,
});
const person = (id, text) => ({ id, who: "person", text, unix_ms: id });
const note = (id, type) => ({ id, who: "system", text: "?", unix_ms: id, note: { type } });

describe("the conversation", () => {
  const of = (lines) => conversation(lines).map(({ line, lines }) => [line.text, lines.length]);

  it("shows a question that was repeated once, in its fullest words", () => {
    const lines = [
      person(1, "the bowl"),
      robot(2, 7, 1, "Is it in the dishwasher?"),
      robot(3, 7, 2, "In the dishwasher?"),
      robot(4, 7, 3, "The dishwasher, the counter or the cabinet?"),
      robot(5, 8, 1, "Is it big?"),
    ];
    assert.deepEqual(of(lines), [
      ["the bowl", 1],
      ["The dishwasher, the counter or the cabinet?", 3],
      ["Is it big?", 1],
    ]);
  });

  it("shows it again where somebody spoke in between", () => {
    const lines = [robot(1, 7, 1, "Is it big?"), person(2, "what?"), robot(3, 7, 2, "Big?")];
    assert.equal(of(lines).length, 3);
  });

  it("has ends of requests, and leaves other notes to the events", () => {
    const end = { ...note(3, "ended"), outcome: "delivered" };
    const lines = [
      robot(1, 7, 1, "Is it big?"),
      note(2, "service_lost"),
      robot(4, 7, 2, "Big?"),
      end,
    ];
    assert.deepEqual(of(lines), [
      ["Is it big?", 2],
      ["?", 1],
    ]);
    const own = [{ ...note(undefined, "link_lost"), unix_ms: 9 }];
    const types = (most) => events(lines, own, most).map(({ note }) => note.type);
    assert.deepEqual(types(5), ["link_lost", "service_lost"]);
    assert.deepEqual(types(1), ["link_lost"]);
  });
});

describe("notes", () => {
  const table = (code) => {
    const path = `../../../services/console/page/strings/${code}.json`;
    return JSON.parse(readFileSync(new URL(path, import.meta.url), "utf8"));
  };
  const OUTCOMES = "delivered refused failed cancelled abandoned scene_changed not_here".split(" ");
  const NOTES = "stopped released service_lost service_back link_lost link_back".split(" ");

  for (const code of ["en", "de"]) {
    it(`are in the page's words: ${code}`, () => {
      const t = translator(code, [table(code)]);
      for (const outcome of OUTCOMES) {
        const end = { outcome, object: "cup", questions: 2, seconds: 12.34 };
        assert.doesNotMatch(endWords(end, t), /last\.|\{/, outcome);
      }
      for (const type of NOTES) {
        const words = noteWords({ text: "?", note: { type, service: "arm" } }, t);
        assert.doesNotMatch(words, /note\.|\{|\?/, type);
      }
    });
  }

  it("have figures and plurals of the language", () => {
    const t = translator("de", [table("de")]);
    const ended = { type: "ended", object: "cup", questions: 1, seconds: 12.34 };
    const line = { text: "?", outcome: "delivered", note: ended };
    assert.equal(noteWords(line, t), "Gebracht: cup, nach 1 Frage, 12,3 s");
    assert.equal(noteWords({ text: "as it was" }, t), "as it was");
    const back = { type: "service_back", service: "arm", exit: "signal 9" };
    assert.match(noteWords({ text: "?", note: back }, t), /^arm .*signal 9/);
  });
});
