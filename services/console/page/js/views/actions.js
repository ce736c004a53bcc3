// @ts-check
import { eachFrame, h, setAttribute, setText } from "../dom.js";
import { icon } from "../icons.js";
import { escapeStops, stopper } from "../stop.js";
import { attempt } from "./attempt.js";

/** A press so soon after the stop is not meant for what the button has become, milliseconds. */
const LATCH_MS = 800;
/** Duration of the button's confirmation before motion is released, milliseconds. */
const ASK_MS = 6_000;

/** A press of Escape and the end of the full screen within this time are one, milliseconds. */
const SAME_MS = 80;
/**
 * Window after a key or a press within which leaving the full screen is attributed to it,
 * milliseconds.
 */
const ASIDE_MS = 600;

/**
 * The stop. It acts when it is touched, before anything is drawn; what it becomes, resume, wants two
 * separate presses.
 * @param {HTMLElement} element
 * @param {{link: any, store: any, t: (key: string, args?: object) => string}} context
 */
export function mountActions(element, context) {
  const { store, link, t } = context;
  const words = h("span", { class: "stop-words" });
  const hint = h("span", { class: "stop-hint" });
  const mark = h("span", { class: "stop-mark" }, icon("stop", 34));
  const text = h("span", { class: "stop-text" }, words, hint);
  const button = h("button", { type: "button", id: "stop", class: "stop" }, mark, text);
  element.append(button);

  const press = stopper(context);
  let pressedAt = Number.NEGATIVE_INFINITY;
  const touch = matchMedia("(hover: none)");
  let askedAt = null;
  let asking = 0;
  let escapedAt = null;
  let otherAt = Number.NEGATIVE_INFINITY;

  const mode = () => {
    if (!store.get("arm")?.stopped) return "stop";
    return askedAt === null ? "resume" : "confirm";
  };
  const stop = () => {
    press();
    pressedAt = performance.now();
    askedAt = null;
    show();
  };
  const resume = () => {
    const now = performance.now();
    if (now - pressedAt < LATCH_MS || (askedAt !== null && now - askedAt < LATCH_MS / 2)) return;
    clearTimeout(asking);
    if (askedAt === null) {
      askedAt = now;
      asking = setTimeout(forget, ASK_MS);
    } else {
      askedAt = null;
      attempt(link.do("resume"), context);
    }
    show();
  };
  const forget = () => {
    askedAt = null;
    draw();
  };

  button.addEventListener("pointerdown", (event) => {
    if (event.button === 0 && mode() === "stop") stop();
  });
  button.addEventListener("keydown", (event) => {
    const pressed = event.key === "Enter" || event.key === " ";
    if (pressed && mode() === "stop" && !event.repeat) stop();
    if (pressed && event.repeat) event.preventDefault();
  });
  button.addEventListener("click", () => {
    if (mode() !== "stop") resume();
    else if (performance.now() - pressedAt > LATCH_MS) stop();
  });
  // A dialog dims the page, but not the stop: pressing where it is seen stops, and shows the page.
  const onBackdrop = (event) => {
    const dialog = event.target;
    if (!(dialog instanceof HTMLDialogElement) || mode() !== "stop") return;
    if (isAt(dialog, event) || !isAt(button, event)) return;
    stop();
    dialog.close();
  };
  addEventListener("pointerdown", onBackdrop, { capture: true });
  const countEscape = (now) => {
    if (escapeStops(escapedAt, now, store.get("arm")?.moving === true)) stop();
    escapedAt = now;
  };
  const onKey = (event) => {
    if (event.key === "Escape" && !event.isComposing) countEscape(event.timeStamp);
    else otherAt = event.timeStamp;
  };
  // The stop is in what covers the page: the full screen, or a sheet.
  const place = () => {
    const full = document.fullscreenElement;
    const host = full ?? store.get("cover") ?? element;
    if (button.parentElement !== host) host.append(button);
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
    const is = mode();
    const sending = store.get("stop")?.state === "sent" && is === "stop";
    const down = store.get("link")?.state !== "up";
    setAttribute(button, "data-mode", is);
    setAttribute(button, "data-down", down);
    setText(words, t(sending ? "stop.sending" : `stop.${is}`));
    const moving = store.get("arm")?.moving === true;
    const keys = touch.matches ? t("stop.touch") : t(moving ? "stop.key_moving" : "stop.key");
    const unconfirmed =
      store.get("motion")?.unconfirmed || store.get("stop")?.state === "undelivered";
    const usual = is === "stop" ? keys : t(`stop.${is}.more`);
    setText(hint, down ? t("stop.down") : unconfirmed ? t("stop.unconfirmed") : usual);
    const drawn = is === "stop" ? "stop" : "play";
    if (mark.dataset.icon !== drawn) mark.replaceChildren(icon(drawn, 34));
    mark.dataset.icon = drawn;
  };
  const draw = eachFrame(show);
  store.subscribe(["arm", "stop", "link", "motion"], draw);
  draw();
}

/** Returns whether a pointer is on an element, regardless of anything in between. */
function isAt(element, { clientX, clientY }) {
  const { left, right, top, bottom } = element.getBoundingClientRect();
  return clientX >= left && clientX <= right && clientY >= top && clientY <= bottom;
}
