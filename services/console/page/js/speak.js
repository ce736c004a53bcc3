// @ts-check
// Words of the operator that were typed or clicked: one way to the robot for both.

import { whoControls } from "./model/turn.js";
import { whoSpeaks } from "./settings/person.js";

/** Longest wait for a connection that has just broken, milliseconds. */
const OUTAGE_MS = 4_000;

/**
 * Says words to the robot; takes control if there is no operator.
 * @param {string} text
 * @param {{link: any, store: any}} context
 * @param {{began?: number, seen?: number}} [when] when the person began, and the latest prompt that the
 *   page showed then: the words answer no later one
 * @returns {Promise<any>} the server's answer
 */
export async function speak(text, { link, store }, when = {}) {
  const { began = performance.now(), seen = shownPrompt(store) } = when;
  await link.up(OUTAGE_MS);
  if (whoControls(store.get("control"), store.get("welcome")) === "free") {
    await link.do("take_control");
  }
  const times = { began_ms: link.toServer(began), ended_ms: link.serverNow() };
  return link.do("say", { text, source: "typed", seen, from: whoSpeaks(), ...times });
}

/**
 * The robot's latest prompt that the page shows: in the conversation, or in large type, where a
 * question appears before its voice begins.
 * @param {{get: (section: string) => any}} store
 * @returns {number} 0 for none
 */
export function shownPrompt(store) {
  const spoken = (store.get("lines") ?? []).findLast((line) => line.said)?.said[0] ?? 0;
  return Math.max(spoken, store.get("dialogue")?.prompt ?? 0);
}

/**
 * Words for an object, as the robot itself uses them.
 * @param {{description: string}} object of the section `scene`
 */
export const objectWords = ({ description }) => `the ${description}`;
