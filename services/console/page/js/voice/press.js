// @ts-check
/** A shorter press was a click, which lasts until the next one, milliseconds. */
const CLICK_MS = 350;

/**
 * @typedef {"idle"|"held"|"latched"|"closing"} Press
 * `held`: talking while the key is down; `latched`: talking until the next click; `closing`: not
 * talking, and the key that ended it is still down
 * @typedef {{press: Press, since: number}} PressState
 */

/** @returns {PressState} */
export function idle() {
  return { press: "idle", since: 0 };
}

/** @param {PressState} state */
export function talks({ press }) {
  return press === "held" || press === "latched";
}

/**
 * Interprets presses and holds of a talk button.
 * @param {PressState} state
 * @param {"down"|"up"|"click"|"cancel"} event `click`: one without a press, e.g. of a screen reader
 * @param {number} nowMs
 * @returns {PressState}
 */
export function pressed(state, event, nowMs) {
  switch (event) {
    case "down":
      if (state.press === "idle") return { press: "held", since: nowMs };
      return state.press === "latched" ? { press: "closing", since: nowMs } : state;
    case "up":
      if (state.press === "closing") return idle();
      if (state.press !== "held") return state;
      return nowMs - state.since < CLICK_MS ? { ...state, press: "latched" } : idle();
    case "click":
      return talks(state) ? idle() : { press: "latched", since: nowMs };
    default:
      return idle();
  }
}
