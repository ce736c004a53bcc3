// @ts-check
import { eachFrame, h, setAttribute, setText } from "../dom.js";
import { icon } from "../icons.js";
import { deliveryOf, escapeStops } from "../stop.js";
import { notify } from "./attempt.js";

/** A press and the click that follows it are one, milliseconds. */
const CLICK_MS = 800;
/** A press of Escape and the end of the full screen within this time are one, milliseconds. */
const SAME_MS = 80;
/**
 * Window after a key or a press within which leaving the full screen is attributed to it,
 * milliseconds.
 */
const ASIDE_MS = 600;

/**
 * STOP. It acts when it is touched, before anything is drawn, and it never becomes anything else: pressed
 * again, it sends the stop again.
 * @param {HTMLElement} element
 * @param {object} context
 * @param {any} context.store
 * @param {(key: string, args?: object) => string} context.t
 * @param {() => void} context.stop sends a stop
 * @param {import("../model/hold.js").Hold} [context.hold] of Resume: learns of every press
 */
export function mountActions(element, { store, t, stop: send, hold }) {
  const words = h("span", { class: "stop-words", text: t("stop.stop") });
  const hint = h("span", { class: "stop-hint" });
  const text = h("span", { class: "stop-text" }, words, hint);
  const mark = h("span", { class: "stop-mark" }, icon("stop", 34));
  const button = h("button", { type: "button", id: "stop", class: "stop" }, mark, text);
  element.append(button);

  const touch = matchMedia("(hover: none)");
  let pressedAt = Number.NEGATIVE_INFINITY;
  let escapedAt = null;
  let otherAt = Number.NEGATIVE_INFINITY;

  const notice = () => hold?.press(performance.now());
  const stop = () => {
    notice();
    pressedAt = performance.now();
    send();
    show();
  };

  button.addEventListener("pointerdown", stop);
  button.addEventListener("contextmenu", (event) => event.preventDefault());
  button.addEventListener("keydown", (event) => {
    if (event.key !== "Enter" && event.key !== " ") return;
    if (!event.repeat) return stop();
    notice();
    event.preventDefault();
  });
  button.addEventListener("click", () => {
    notice();
    if (performance.now() - pressedAt > CLICK_MS) stop();
  });
  // Where STOP was before a sheet took it: pressing there stops, and shows the page.
  const onBackdrop = (event) => {
    const dialog = event.target;
    if (!(dialog instanceof HTMLDialogElement) || isAt(dialog, event)) return;
    if (!isAt(element, event)) return;
    stop();
    dialog.close();
  };
  addEventListener("pointerdown", onBackdrop, { capture: true });
  const countEscape = (now) => {
    notice();
    if (escapeStops(escapedAt, now, store.get("now").moves)) stop();
    escapedAt = now;
  };
  const onKey = (event) => {
    if (event.key === "Escape" && !event.isComposing) return countEscape(event.timeStamp);
    otherAt = event.timeStamp;
    // On Resume itself Space holds; everywhere else it is a press.
    if (event.code === "Space" && !event.target.closest?.(".resume-hold")) notice();
  };
  // STOP is in the cover of the page: the full screen, or a sheet.
  const place = () => {
    const full = document.fullscreenElement;
    const host = full ?? store.get("cover") ?? element;
    if (button.parentElement !== host) {
      element.style.minHeight = host === element ? "" : `${element.offsetHeight}px`;
      host.append(button);
    }
    button.classList.toggle("floats", full !== null);
  };
  store.subscribe("cover", place);
  const onFullScreen = ({ timeStamp }) => {
    const full = document.fullscreenElement;
    place();
    // Most browsers keep the key that leaves the full screen to themselves.
    const known = escapedAt !== null && timeStamp - escapedAt < SAME_MS;
    if (!full && !known && timeStamp - otherAt > ASIDE_MS) countEscape(timeStamp);
  };
  addEventListener("keydown", onKey, { capture: true });
  addEventListener(
    "pointerdown",
    () => {
      otherAt = performance.now();
    },
    { capture: true },
  );
  document.addEventListener("fullscreenchange", onFullScreen);

  const show = () => {
    const state = stateOf(store);
    setAttribute(button, "data-state", state);
    const idle = touch.matches ? "touch" : store.get("now").moves ? "key_moving" : "key";
    setText(hint, t(`stop.${state === "idle" ? idle : state}`));
  };
  store.subscribe("stop", ({ ageMs }) => {
    if (ageMs) notify(t("stop.late", { s: Math.round(ageMs / 1_000) }));
  });
  const draw = eachFrame(show);
  store.subscribe(["now", "stop", "link", "motion"], draw);
  show();
}

/**
 * Remarks about the stop, the gravest first.
 * @param {{get: (section: string) => any}} store
 * @returns {"unsent"|"down"|"unconfirmed"|"sending"|"stopped"|"idle"}
 */
function stateOf(store) {
  const delivery = deliveryOf(store);
  if (delivery === "unsent" || delivery === "unconfirmed") return delivery;
  const { is, atRest, why } = store.get("now");
  if (is === "disconnected" && why !== "connecting") return "down";
  if (atRest) return "stopped";
  return delivery ?? "idle";
}

/** Returns whether a pointer is on an element, regardless of anything in between. */
function isAt(element, { clientX, clientY }) {
  const { left, right, top, bottom } = element.getBoundingClientRect();
  return clientX >= left && clientX <= right && clientY >= top && clientY <= bottom;
}
