// @ts-check
import { addressOf } from "../place.js";

/** Delay before the robot's description is requested again after a failure, milliseconds. */
const RETRY_MS = 2_000;

/**
 * Gets the robot's description, and again whenever the connection has come back.
 * @param {any} link
 * @param {(tree: import("./elements.js").Tree) => Promise<void>} use fails if it cannot be used
 * @param {(why: string, isKnown: boolean) => void} failed `isKnown`: there is an older one
 */
export function followDescription(link, use, failed) {
  let known = "";
  let retry = 0;
  const load = async () => {
    clearTimeout(retry);
    try {
      const answer = await fetch(addressOf("/robot.urdf"));
      if (!answer.ok) throw new Error(`${answer.status}`);
      const text = await answer.text();
      if (text === known) return;
      await use(treeOf(text));
      known = text;
    } catch (error) {
      failed(error instanceof Error ? error.message : String(error), known !== "");
      retry = setTimeout(load, RETRY_MS);
    }
  };
  let wasUp = true;
  link.on("status", ({ state }) => {
    if (state === "up" && !wasUp) load();
    wasUp = state === "up";
  });
  load();
}

/** The elements of a description: only the page can read XML. @param {string} text */
function treeOf(text) {
  const parsed = new DOMParser().parseFromString(text, "text/xml");
  const fault = parsed.querySelector("parsererror");
  if (fault) throw new Error((fault.querySelector("div") ?? fault).textContent?.trim());
  return elementTree(parsed.documentElement);
}

/** @param {Element} element @returns {import("./elements.js").Tree} */
function elementTree(element) {
  return {
    name: element.nodeName,
    attributes: Object.fromEntries([...element.attributes].map(({ name, value }) => [name, value])),
    children: [...element.children].map(elementTree),
  };
}
