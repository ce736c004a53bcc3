// @ts-check
import { linkTo } from "./address.js";
import { fileOf } from "./model.js";

/** Time until the memory of a file that was offered is given back, milliseconds. */
const KEEP_MS = 60_000;

/**
 * Offers an interaction as a file.
 * @param {import("./model.js").Interaction} past
 * @param {{group: string, version: string}} from
 */
export function download(past, from) {
  const href = URL.createObjectURL(new Blob([fileOf(past, from)], { type: "application/json" }));
  const name = `${from.group}-interaction-${past.interaction}.json`;
  const link = Object.assign(document.createElement("a"), { href, download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(href), KEEP_MS);
}

/**
 * Copies the address of an interaction; if the browser forbids it, the address bar has it.
 * @param {number} interaction
 * @returns {Promise<boolean>}
 */
export async function copyLink(interaction) {
  const address = new URL(linkTo(interaction), location.origin + location.pathname).href;
  try {
    await navigator.clipboard.writeText(address);
    return true;
  } catch {
    return false;
  }
}
