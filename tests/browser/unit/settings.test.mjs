// The look of the page: what can be chosen, what is kept.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { describe, it } from "node:test";
import { choose, chosen, LOOK } from "../../../services/console/page/js/settings/look.js";

const PAGE = new URL("../../../services/console/page/", import.meta.url);
const read = (path) => readFileSync(new URL(path, PAGE), "utf8");

describe("the look", () => {
  for (const [name, values] of Object.entries(LOOK)) {
    it(`of ${name} is kept, but for the default`, () => {
      const root = { dataset: {} };
      const kept = new Map();
      const keep = (key, value) => kept.set(key, value);
      assert.equal(chosen(name, root), values[0]);
      for (const value of values.slice(1)) {
        choose(name, value, root, keep);
        assert.deepEqual([chosen(name, root), kept.get(name)], [value, value]);
      }
      choose(name, values[0], root, keep);
      assert.deepEqual([root.dataset, kept.get(name)], [{}, null]);
    });
  }

  it("is the default where the browser has kept something else", () => {
    assert.equal(chosen("theme", { dataset: { theme: "sepia" } }), "auto");
  });

  it("is put in force by early.js before anything is painted", () => {
    const early = read("js/early.js");
    const document = { documentElement: { dataset: {} } };
    const localStorage = { getItem: (key) => `kept ${key}` };
    new Function("document", "localStorage", early)(document, localStorage);
    assert.deepEqual(Object.keys(document.documentElement.dataset), Object.keys(LOOK));
  });

  it("has words for every value", () => {
    const english = JSON.parse(read("strings/en.json"));
    for (const [name, values] of Object.entries(LOOK)) {
      for (const value of values) assert.ok(`settings.${name}.${value}` in english, value);
    }
  });
});
