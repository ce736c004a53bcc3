// @ts-check
/** A connection that is back sooner changes nothing that is seen, milliseconds. */
const GRACE_MS = 1_200;

/**
 * Without a connection the robot's state is unknown: the store's section `stale` is true, and what the page
 * shows is dimmed.
 * @param {{store: any}} context
 */
export function mountStale({ store }) {
  let timer = 0;
  const set = (stale) => {
    document.documentElement.toggleAttribute("data-stale", stale);
    if (store.get("stale") !== stale) store.set("stale", stale);
  };
  store.subscribe("link", ({ state }) => {
    if (state !== "up") {
      timer ||= window.setTimeout(set, GRACE_MS, true);
      return;
    }
    clearTimeout(timer);
    timer = 0;
    set(false);
  });
}
