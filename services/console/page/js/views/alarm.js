// @ts-check
import { h, setText } from "../dom.js";
import { icon } from "../icons.js";
import { banner, isStopped, whoControls } from "../model/turn.js";

/** A connection that is back sooner is not worth a word, milliseconds. */
const GRACE_MS = 1_200;

/**
 * Alerts: no connection, a stop, an undelivered stop; and, as polite announcements, the robot's
 * sentences.
 * @param {HTMLElement} element a region that interrupts
 * @param {HTMLElement} polite a region that waits
 * @param {{link: any, store: any, t: (key: string, args?: object) => string, isParticipant?: boolean}} context
 *   a participant has no Resume, and is told what to do
 */
export function mountAlarm(element, polite, { link, store, t, isParticipant = false }) {
  const text = h("p", { class: "alarm-text" });
  const act = h("button", { type: "button", class: "alarm-act", onclick: () => link.reconnect() });
  const bar = h("div", { class: "alarm-bar", hidden: true }, icon("down", 22), text, act);
  element.append(bar);
  let timer = 0;
  let shown = "";

  const show = (key, args = {}) => {
    shown = key;
    setText(text, key && t(`alarm.${key}`, args));
    bar.hidden = key === "";
    // The sign and the button show a stop to the eye; to the ear it is said here.
    bar.classList.toggle("hidden", key === "stopped");
    if (key === "") return;
    const here = ["replaced", "gave_way"].includes(key);
    setText(act, t(here ? "alarm.use_here" : "alarm.again"));
    act.hidden = !here && !["offline", "undelivered"].includes(key);
  };
  const look = () => {
    const state = store.get("link")?.state;
    const stop = store.get("stop")?.state;
    if (state === "replaced" || state === "gave_way") return show(state);
    if (state !== "up") {
      if (stop === "undelivered") return show("undelivered");
      timer ||= setTimeout(() => show("offline"), GRACE_MS);
      return;
    }
    clearTimeout(timer);
    timer = 0;
    const arm = store.get("arm");
    const late = store.get("motion")?.unconfirmed;
    if (late || stop === "undelivered") {
      return show("unconfirmed", { why: t(`alarm.why.${late?.why ?? "silent"}`) });
    }
    const key = isStopped(arm) ? (isParticipant ? "participant" : "stopped") : "";
    if (key !== shown) show(key);
  };
  store.subscribe(["link", "stop", "arm", "motion"], look);
  look();

  let turn = "";
  store.subscribe(["turn", "link"], () => {
    const who = whoControls(store.get("control"), store.get("welcome"));
    const { key, tone } = banner(store.get("link"), store.get("turn"), store.get("arm"), who);
    if (key === turn || tone === "down") return;
    turn = key;
    if (tone === "arm" || key.endsWith("idle")) setText(polite, t(`turn.${key}`));
  });
  let heard = Number.POSITIVE_INFINITY;
  store.subscribe("lines", (lines) => {
    const last = lines.at(-1);
    if (last && last.id > heard && last.who === "robot") setText(polite, last.text);
    heard = last?.id ?? 0;
  });
}
