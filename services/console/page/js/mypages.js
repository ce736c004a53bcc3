// @ts-check
import { place } from "./place.js";

/**
 * The other pages of the same person: tabs of one browser report to each other which viewers they are, so
 * that control moves between them at once.
 * @param {{link: any, store: any}} context
 * @returns {{isMine: (viewer: string|null) => boolean, fetch: () => void}} `fetch` has the page of
 *   mine that is in control hand it over to this one
 */
export function myPages({ link, store }) {
  const own = () => store.get("welcome")?.viewer ?? null;
  if (typeof BroadcastChannel === "undefined") return { isMine: () => false, fetch: () => {} };
  // Pages of other robots at the same gateway number their viewers, too.
  const channel = new BroadcastChannel(`whichone.pages${place}`);
  /** @type {Set<string>} */
  const others = new Set();
  const say = (what) => own() && channel.postMessage({ what, viewer: own() });

  channel.onmessage = ({ data }) => {
    if (data.viewer === own()) return;
    if (data.what === "gone") others.delete(data.viewer);
    else others.add(data.viewer);
    if (data.what === "here") say("too");
    const control = store.get("control");
    if (data.what === "give" && control?.operator === own()) {
      link.do("give_control", { viewer: data.viewer }).catch(() => {});
    }
    if (control) store.set("control", { ...control });
  };
  link.on("welcome", () => say("here"));
  addEventListener("pagehide", () => say("gone"));
  say("here");
  return { isMine: (viewer) => viewer !== null && others.has(viewer), fetch: () => say("give") };
}
