import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { describe, it } from "node:test";
import {
  chooseLanguage,
  LANGUAGES,
  translator,
} from "../../../services/console/page/js/strings.js";

const PAGE = new URL("../../../services/console/page/", import.meta.url);
const read = (path) => readFileSync(new URL(path, PAGE), "utf8");
const table = (language) => JSON.parse(read(`strings/${language}.json`));

/** The page's own sources. */
function sources(folder = "js/") {
  const entries = readdirSync(new URL(folder, PAGE), { withFileTypes: true });
  return entries.flatMap((entry) => {
    if (entry.isDirectory()) return sources(`${folder}${entry.name}/`);
    return entry.name.endsWith(".js") ? [`${folder}${entry.name}`] : [];
  });
}

describe("the translator", () => {
  const t = translator("de", [
    { one: "eins", "n.one": "{n} Frage", "n.other": "{n} Fragen" },
    { two: "two" },
  ]);

  it("takes the first table that has the key, and shows the key of none", () => {
    assert.equal(t("one"), "eins");
    assert.equal(t("two"), "two");
    assert.equal(t("three"), "three");
    assert.equal(t("toString"), "toString");
    assert.equal(t.has("two"), true);
    assert.equal(t.has("toString"), false);
  });

  it("fills in arguments, numbers as the language writes them, and its plural", () => {
    const u = translator("de", [{ x: "{a} von {b}, {c}" }]);
    assert.equal(u("x", { a: 1.5, b: "<b>" }), "1,5 von <b>, {c}");
    assert.equal(t("n", { n: 1 }), "1 Frage");
    assert.equal(t("n", { n: 1.2 }), "1,2 Fragen");
    assert.equal(t("n"), "{n} Fragen");
  });
});

describe("the language", () => {
  it("is the address's, else what was chosen, else the browser's, else English", () => {
    assert.equal(chooseLanguage("?lang=de", "en", ["en"]), "de");
    assert.equal(chooseLanguage("", "de", ["en"]), "de");
    assert.equal(chooseLanguage("?lang=xx", null, ["fr", "de-AT"]), "de");
    assert.equal(chooseLanguage("", null, ["fr"]), "en");
  });
});

describe("the tables", () => {
  const english = table("en");

  it("hold every key that the page names", () => {
    const named = /\bt\(\s*"([^"`]+)"/g;
    const missing = sources().flatMap((path) =>
      [...read(path).matchAll(named)]
        .map(([, key]) => key)
        .filter((key) => !(key in english) && !(`${key}.other` in english))
        .map((key) => `${path}: ${key}`),
    );
    assert.deepEqual(missing, []);
    const marks = /data-t(?:-\w+)?="([^"]+)"/g;
    for (const page of ["index.html", "login.html", "404.html", "history.html"]) {
      for (const [, key] of read(page).matchAll(marks))
        assert.ok(key in english, `${page}: ${key}`);
    }
  });

  it("have words for whose turn it is, and for what is offered", () => {
    const states = "idle listening hearing asked speaking".split(" ").map((s) => `theirs_${s}`);
    const turns = states.flatMap((state) => [`turn.${state}`, `turn.${state}.more`]);
    const offered = [...read("js/model/answers.js").matchAll(/"((?:answer|delivery)\.\w+)"/g)];
    assert.equal(offered.length, 8);
    for (const key of [...turns, ...offered.map(([, key]) => key)]) assert.ok(english[key], key);
  });

  for (const language of LANGUAGES.slice(1)) {
    it(`of ${language} are complete`, () => {
      const missing = Object.keys(english).filter((key) => !(key in table(language)));
      assert.deepEqual(missing, []);
    });

    it(`of ${language} have the arguments of the English one, and no key beyond it`, () => {
      const names = (text) => [...text.matchAll(/\{(\w+)\}/g)].map(([, name]) => name).sort();
      for (const [key, text] of Object.entries(table(language))) {
        assert.ok(key in english, key);
        const unknown = names(text).filter((name) => !names(english[key]).includes(name));
        assert.deepEqual(unknown, [], key);
        assert.notEqual(text.trim(), "", key);
      }
    });
  }
});
