// @ts-check
/** Deadline for an answer to a stop, milliseconds: the server answers after one second at most. */
const CONFIRM_MS = 1_500;
/** Delay before a stop that was refused is sent again, milliseconds. */
const AGAIN_MS = 500;
/** Age from which a stop that is confirmed is a late one, milliseconds. */
const LATE_MS = 2_000;

/**
 * @typedef {object} StopSection the store's section `stop`
 * @property {"idle"|"sent"|"undelivered"} state `undelivered` until a confirmation comes
 * @property {number} [ageMs] of a late stop that has just been confirmed
 */

/**
 * Stops the robot's motion. The stop is sent again until the arm confirms it, also to a server that was
 * restarted meanwhile. While the server says in its section `motion` that a stop is unconfirmed, it
 * repeats it itself, for every page.
 *
 * Its listener has to be the first of the link, so that a stop that waits is sent before everything else.
 * @param {{link: any, store: any, now?: () => number}} context
 * @returns {() => Promise<void>} presses stop
 */
export function stopper({ link, store, now = () => performance.now() }) {
  /** When the stop was pressed that is not confirmed. @type {number|null} */
  let pressedAt = null;
  /** True if the server has the stop and repeats it. */
  let isHandedOver = false;
  /** True if a stop was sent and not confirmed in time: the warning stays until it is. */
  let late = false;
  let again = 0;
  const notify = (state) => {
    if (store.get("stop")?.state !== state) store.set("stop", { state });
  };
  const done = () => {
    if (pressedAt === null) return;
    const ageMs = now() - pressedAt;
    [pressedAt, isHandedOver, late] = [null, false, false];
    clearTimeout(again);
    if (ageMs < LATE_MS) notify("idle");
    else store.set("stop", { state: "idle", ageMs });
  };
  const send = async () => {
    clearTimeout(again);
    try {
      await link.do("stop", {}, CONFIRM_MS);
      done();
    } catch (error) {
      if (pressedAt === null) return;
      if (error.code === "refused" && store.get("motion")?.unconfirmed) {
        isHandedOver = true;
        return notify("idle");
      }
      late ||= error.code === "late" || error.code === "refused";
      notify("undelivered");
      if (error.code === "late") link.reconnect();
      if (error.code === "refused")
        again = setTimeout(() => pressedAt !== null && send(), AGAIN_MS);
    }
  };
  store.set("stop", { state: "idle" });
  link.on("status", ({ state }) => {
    if (pressedAt === null) return;
    if (state !== "up") {
      // A server that is restarted no longer knows the stop.
      isHandedOver = false;
      notify("undelivered");
    } else if (store.get("stop")?.state === "undelivered") {
      if (!late) notify("sent");
      send();
    }
  });
  store.subscribe("motion", (motion) => {
    if (isHandedOver && !motion.unconfirmed) done();
  });
  return () => {
    pressedAt ??= now();
    [isHandedOver, late] = [false, false];
    const sent = send();
    if (link.isUp) notify("sent");
    return sent;
  };
}

/**
 * Outcome of a stop pressed here or elsewhere; null if nothing is left to say.
 * @param {{get: (section: string) => any}} store
 * @returns {"unsent"|"unconfirmed"|"sending"|null}
 */
export function deliveryOf(store) {
  const own = store.get("stop")?.state;
  const isUp = store.get("link")?.state === "up";
  if (own === "undelivered" && !isUp) return "unsent";
  if (own === "undelivered" || (isUp && store.get("motion")?.unconfirmed)) return "unconfirmed";
  return own === "sent" ? "sending" : null;
}

/** Two presses of Escape within this time stop the robot, milliseconds. */
const TWICE_MS = 900;

/**
 * Returns whether a press of Escape means stop: the second of two, or any while the arm moves.
 * @param {number|null} beforeMs when it was last pressed
 * @param {number} nowMs
 * @param {boolean} moving
 */
export function escapeStops(beforeMs, nowMs, moving) {
  return moving || (beforeMs !== null && nowMs - beforeMs <= TWICE_MS);
}
