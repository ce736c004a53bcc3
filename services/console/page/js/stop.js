// @ts-check
/** Deadline for an answer to a stop, milliseconds: the server answers after one second at most. */
const CONFIRM_MS = 1_500;
/** Delay before a stop that was refused is sent again, milliseconds. */
const AGAIN_MS = 500;

/**
 * Stops the robot's motion. Without a connection or an answer the page says so, and sends the stop again
 * until there is one. From the server's section `motion` on, the server does so, for every page. The
 * state is the store's section `stop`: `idle`, `sent`, or `undelivered` until a confirmation comes.
 * @param {{link: any, store: any}} context
 * @returns {() => void} presses stop
 */
export function stopper({ link, store }) {
  let wanted = false;
  /** True if a stop was sent and not confirmed in time: the warning stays until it is. */
  let late = false;
  let again = 0;
  const notify = (state) => {
    if (store.get("stop")?.state !== state) store.set("stop", { state });
  };
  const done = () => {
    wanted = false;
    notify("idle");
  };
  const send = async () => {
    clearTimeout(again);
    try {
      await link.do("stop", {}, CONFIRM_MS);
      done();
    } catch (error) {
      if (!wanted || store.get("motion")?.unconfirmed) return done();
      late ||= error.code === "late" || error.code === "refused";
      notify("undelivered");
      if (error.code === "late") link.reconnect();
      if (error.code === "refused") again = setTimeout(() => wanted && send(), AGAIN_MS);
    }
  };
  store.set("stop", { state: "idle" });
  link.on("status", ({ state }) => {
    if (!wanted || state !== "up" || store.get("stop")?.state !== "undelivered") return;
    if (!late) notify("sent");
    send();
  });
  return () => {
    [wanted, late] = [true, false];
    const sent = send();
    if (link.isUp) notify("sent");
    return sent;
  };
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
