import assert from "node:assert/strict";
import { describe, it } from "node:test";
import { nameOf } from "../../../services/console/page/js/settings/person.js";

describe("the name of who speaks", () => {
  it("has no spaces around it and at most 64 bytes, never half a character", () => {
    assert.equal(nameOf("  Ann Lee "), "Ann Lee");
    assert.equal(nameOf("   "), "");
    assert.equal(nameOf("n".repeat(70)).length, 64);
    assert.equal(nameOf("ä".repeat(40)), "ä".repeat(32));
    assert.equal(nameOf(`n${"👩".repeat(20)}`), `n${"👩".repeat(15)}`);
  });
});
