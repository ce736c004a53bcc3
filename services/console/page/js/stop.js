// @ts-check
/** Deadline for the robot to confirm a stop, milliseconds. */
const CONFIRM_MS = 1_500;

/**
 * Stops the robot's motion. Without a connection or a confirmation the page says so, and sends the
 * stop again until it is confirmed. The state is the store's section `stop`: `idle`, `sent`, or
 * `undelivered` until a confirmation comes.
 * @param {{link: any, store: any}} context
 * @param {(error: Error) => void} refused called with the reason of a refusal
 * @returns {() => void} presses stop
 */
export function stopper({ link, store }, refused) {
  let wanted = false;
  /** True if a stop was sent and not confirmed in time: the warning stays until it is. */
  let late = false;
  const notify = (state) => {
    if (store.get("stop")?.state !== state) store.set("stop", { state });
  };
  const send = async () => {
    try {
      await link.do("stop", {}, CONFIRM_MS);
      wanted = false;
      notify("idle");
    } catch (error) {
      if (error.code === "refused") {
        wanted = false;
        notify("idle");
        return refused(error);
      }
      late ||= error.code === "late";
      notify("undelivered");
      if (error.code === "late") link.reconnect();
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
