// @ts-check
/** How long the robot's word that it stops is waited for, milliseconds. */
const CONFIRM_MS = 1_500;

/**
 * Stops the robot's motion, at once and until it is sure: where there is no connection or no answer,
 * the page says so and sends it again as soon as it can. Its state is the store's section `stop`:
 * `idle`, `sent`, `undelivered`.
 * @param {{link: any, store: any}} context
 * @param {(error: Error) => void} refused hears why the robot did not take it
 * @returns {() => void} presses stop
 */
export function stopper({ link, store }, refused) {
  let wanted = false;
  const tell = (state) => {
    if (store.get("stop")?.state !== state) store.set("stop", { state });
  };
  const send = async () => {
    try {
      await link.do("stop", {}, CONFIRM_MS);
      wanted = false;
      tell("idle");
    } catch (error) {
      if (error.code === "refused") {
        wanted = false;
        tell("idle");
        return refused(error);
      }
      tell("undelivered");
      if (error.code === "late") link.reconnect();
    }
  };
  store.set("stop", { state: "idle" });
  link.on("status", ({ state }) => {
    if (wanted && state === "up" && store.get("stop")?.state === "undelivered") {
      tell("sent");
      send();
    }
  });
  return () => {
    wanted = true;
    const sent = send();
    if (link.isUp) tell("sent");
    return sent;
  };
}

/** Two presses of Escape within this time stop the robot, milliseconds. */
const TWICE_MS = 900;

/**
 * Whether a press of Escape means stop: the second of two, or any while the arm moves.
 * @param {number|null} beforeMs when it was last pressed
 * @param {number} nowMs
 * @param {boolean} moving
 */
export function escapeStops(beforeMs, nowMs, moving) {
  return moving || (beforeMs !== null && nowMs - beforeMs <= TWICE_MS);
}
