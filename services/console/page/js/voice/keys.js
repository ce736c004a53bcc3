// @ts-check
import { recall } from "../kept.js";

/** Elements for which the space bar has another meaning. */
const OWN_SPACE =
  "input, textarea, select, button, a[href], summary, label, [contenteditable], [role], dialog";

/**
 * Has a button, and the space bar wherever it is free, held and clicked.
 * @param {HTMLElement} button
 * @param {(event: "down"|"up"|"click"|"cancel") => void} press
 */
export function bindPress(button, press) {
  let down = false;
  const isTalk = (event) => event.code === "Space" || event.code === "Enter";
  const begin = () => {
    down = true;
    press("down");
  };
  const end = () => {
    if (!down) return;
    down = false;
    press("up");
  };
  button.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    // The finger may slide off the button while it holds it.
    button.setPointerCapture?.(event.pointerId);
    begin();
  });
  for (const event of ["pointerup", "pointercancel", "lostpointercapture"]) {
    button.addEventListener(event, end);
  }
  button.addEventListener("contextmenu", (event) => event.preventDefault());
  button.addEventListener("keydown", (event) => {
    if (!isTalk(event) || hasModifier(event)) return;
    event.preventDefault();
    if (!event.repeat) begin();
  });
  button.addEventListener("keyup", (event) => {
    if (!isTalk(event)) return;
    event.preventDefault();
    end();
  });
  // A click without a press comes from a screen reader or a voice control.
  button.addEventListener("click", (event) => event.detail === 0 && press("click"));
  document.addEventListener("keydown", (event) => {
    if (event.code !== "Space" || hasModifier(event) || isTaken(event.target)) return;
    event.preventDefault();
    if (!event.repeat) begin();
  });
  document.addEventListener("keyup", (event) => event.code === "Space" && end());
  addEventListener("blur", () => {
    down = false;
    press("cancel");
  });
}

function hasModifier(event) {
  return event.ctrlKey || event.altKey || event.metaKey;
}

/** @param {EventTarget|null} target */
function isTaken(target) {
  // Who has switched the keys off has switched off this one, too.
  if (recall("keys") === "off") return true;
  if (document.querySelector("dialog[open]")) return true;
  return target instanceof Element && target.closest(OWN_SPACE) !== null;
}
