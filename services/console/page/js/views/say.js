// @ts-check
import { eachFrame, h, setAttribute } from "../dom.js";
import { icon } from "../icons.js";
import { whoControls } from "../model/turn.js";
import { reason, waiting } from "./attempt.js";

/** Longest text, characters. */
const TEXT_MAX = 500;
/** Longest wait of typed text for a connection that has just broken, milliseconds. */
const OUTAGE_MS = 4_000;

/**
 * The line for typing. What was refused comes back into it, with the reason.
 * @param {HTMLElement} element
 * @param {{link: any, store: any, t: any}} context
 */
export function mountSay(element, { link, store, t }) {
  const input = h("input", {
    id: "say-text",
    type: "text",
    maxlength: TEXT_MAX,
    autocomplete: "off",
    autocapitalize: "sentences",
    enterkeyhint: "send",
    "aria-label": t("say.label"),
    "aria-describedby": "say-note",
  });
  const send = h(
    "button",
    { type: "submit", class: "send", "aria-label": t("say.send") },
    icon("send"),
  );
  const note = h("p", { id: "say-note", class: "say-note", role: "status" });
  const form = h("form", { class: "say" }, input, send);
  element.append(form, note);
  let beganAt = null;
  let seen = 0;

  input.addEventListener("input", () => {
    note.textContent = "";
    if (input.value === "") beganAt = null;
    else if (beganAt === null) [beganAt, seen] = [performance.now(), latestPrompt()];
  });
  // Also while the button is disabled: the reason is shown then.
  input.addEventListener("keydown", (event) => {
    if (event.key !== "Enter" || event.isComposing) return;
    event.preventDefault();
    submit();
  });
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    submit();
  });

  async function submit() {
    const text = input.value.trim();
    if (!text) return;
    if (beganAt === null) seen = latestPrompt();
    const began = beganAt ?? performance.now();
    input.value = "";
    beganAt = null;
    note.textContent = "";
    try {
      await link.up(OUTAGE_MS);
      await ready();
      const times = { began_ms: link.toServer(began), ended_ms: link.serverNow() };
      const done = await link.do("say", { text, source: "typed", seen, ...times });
      note.textContent = waiting(done, t);
    } catch (error) {
      if (input.value === "") input.value = text;
      note.textContent = reason(/** @type {any} */ (error), t);
    }
  }

  /** The robot's latest prompt that is shown; 0 for none. */
  function latestPrompt() {
    const lines = store.get("lines") ?? [];
    return lines.findLast((line) => line.said)?.said[0] ?? 0;
  }

  /** Typing takes control if there is no operator. */
  async function ready() {
    if (whoControls(store.get("control"), store.get("welcome")) === "free") {
      await link.do("take_control");
    }
  }

  const draw = eachFrame(() => {
    const who = whoControls(store.get("control"), store.get("welcome"));
    const watching = who === "theirs" || who === "asked";
    input.disabled = watching;
    send.disabled = watching || who === "unknown" || store.get("link")?.state !== "up";
    const noun = store.get("scene")?.noun ?? t("say.thing");
    const words = watching ? t("say.watching") : t("say.placeholder", { noun });
    setAttribute(input, "placeholder", words);
  });
  store.subscribe(["control", "welcome", "link", "scene"], draw);
  draw();
}
