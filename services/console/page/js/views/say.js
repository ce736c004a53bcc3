// @ts-check
import { eachFrame, h, setAttribute } from "../dom.js";
import { icon } from "../icons.js";
import { shownPrompt, speak } from "../speak.js";
import { reason, waiting } from "./attempt.js";

/** Longest text, characters. */
const TEXT_MAX = 500;

/**
 * The line for typing. Refused words come back into it, with the reason.
 * @param {HTMLElement} element
 * @param {{link: any, store: any, t: any}} context
 */
export function mountSay(element, context) {
  const { store, t } = context;
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
    else if (beganAt === null) [beganAt, seen] = [performance.now(), shownPrompt(store)];
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
    const when = beganAt === null ? {} : { began: beganAt, seen };
    input.value = "";
    beganAt = null;
    note.textContent = "";
    try {
      note.textContent = waiting(await speak(text, context, when), t);
    } catch (error) {
      if (input.value === "") input.value = text;
      note.textContent = reason(/** @type {any} */ (error), t);
    }
  }

  const draw = eachFrame(() => {
    const { who } = store.get("now");
    const watching = ["theirs", "asked", "away"].includes(who);
    input.disabled = watching;
    send.disabled = watching || who === "unknown";
    const noun = store.get("scene")?.noun ?? t("say.thing");
    const words = watching ? t("say.watching") : t("say.placeholder", { noun });
    setAttribute(input, "placeholder", words);
  });
  store.subscribe(["now", "scene"], draw);
  // A note is about the state in which it was written.
  let noted = "";
  store.subscribe("now", ({ is, who, service }) => {
    const state = `${is} ${who} ${service?.name}`;
    if (state !== noted) note.textContent = "";
    noted = state;
  });
}
