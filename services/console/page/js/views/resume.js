// @ts-check
import { h, setAttribute, setText } from "../dom.js";
import { mayResume } from "../model/turn.js";
import { attempt } from "./attempt.js";

/** Between two steps of a hold, milliseconds. */
const STEP_EVERY_MS = 30;
/** Keys that hold. */
const KEYS = ["Enter", "NumpadEnter", "Space"];

/**
 * Resume: a bar away from STOP, there only while the arm is stopped and only for who may operate. Its button
 * is held, see `Hold`.
 * @param {HTMLElement} element
 * @param {object} context
 * @param {any} context.link
 * @param {any} context.store
 * @param {(key: string, args?: object) => string} context.t
 * @param {import("../model/hold.js").Hold} context.hold
 */
export function mountResume(element, context) {
  const { link, store, t, hold } = context;
  const fill = h("span", { class: "resume-fill" });
  const words = h("span", { class: "resume-words", id: "resume-words", text: t("resume.words") });
  const hint = h("span", { class: "resume-hint", id: "resume-hint" });
  const labels = { "aria-labelledby": "resume-words", "aria-describedby": "resume-hint" };
  const about = { type: "button", class: "resume-hold", ...labels };
  const button = h("button", about, fill, h("span", { class: "resume-text" }, words, hint));
  element.append(h("p", { class: "resume-more", text: t("resume.more") }), button);

  /** The finger or the key that holds. @type {number|string|null} */
  let holder = null;
  let timer = 0;
  let wasStopped = false;
  /** The stop in force when the hold began; the demo has no numbers. @type {number|undefined} */
  let seen;
  /** The stop in force, as it was shown last. @type {number|undefined} */
  let shown;

  const isShown = () =>
    document.documentElement.dataset.role !== "screen" &&
    store.get("now").atRest &&
    mayResume(store.get("control"), store.get("welcome"));
  const begin = (by, bySpace = false) => {
    if (hold.begin(performance.now(), bySpace)) [holder, seen] = [by, shown];
    watch();
  };
  const end = (by) => {
    if (holder !== by) return;
    holder = null;
    hold.end();
    show();
  };
  const cancel = () => end(holder);
  const step = () => {
    if (hold.step(performance.now())) attempt(link.do("resume", { stop: seen }), context);
    show();
  };
  // The clock runs only while a hold does, or has to wait.
  const watch = () => {
    timer ||= window.setInterval(step, STEP_EVERY_MS);
    show();
  };
  const show = () => {
    const isFree = hold.isFree(performance.now());
    if (hold.share === null) holder = null;
    if (timer && hold.share === null && isFree) {
      clearInterval(timer);
      timer = 0;
    }
    fill.style.scale = `${hold.share ?? 0} 1`;
    setAttribute(button, "data-held", holder !== null);
    setAttribute(button, "data-waits", !isFree && holder === null);
    setText(hint, t("resume.hold"));
  };

  button.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    // A finger that leaves the button ends the hold, so it is not captured.
    if (button.hasPointerCapture(event.pointerId)) button.releasePointerCapture(event.pointerId);
    begin(event.pointerId);
  });
  for (const event of ["pointerup", "pointercancel", "pointerleave"]) {
    button.addEventListener(event, ({ pointerId }) => end(pointerId));
  }
  button.addEventListener("contextmenu", (event) => event.preventDefault());
  button.addEventListener("keydown", (event) => {
    if (!KEYS.includes(event.code)) return;
    event.preventDefault();
    // A key that was pressed elsewhere and repeats here holds nothing.
    if (!event.repeat) begin(event.code, event.code === "Space");
  });
  button.addEventListener("keyup", (event) => {
    if (!KEYS.includes(event.code)) return;
    event.preventDefault();
    end(event.code);
  });
  button.addEventListener("blur", cancel);
  addEventListener("blur", cancel);
  document.addEventListener("visibilitychange", cancel);

  const draw = () => {
    const stopped = store.get("now").is === "stopped";
    const stop = store.get("arm")?.stop;
    // Whoever has stopped it: a moment passes before it can be released here.
    if (stopped && (!wasStopped || stop !== shown)) hold.press(performance.now());
    [wasStopped, shown] = [stopped, stop];
    if (!isShown()) cancel();
    element.hidden = !isShown();
    if (!element.hidden) watch();
  };
  store.subscribe(["now", "arm", "control"], draw);
  store.subscribe("stop", watch);
}
