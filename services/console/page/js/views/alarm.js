// @ts-check
import { h, setText } from "../dom.js";
import { icon } from "../icons.js";
import { banner } from "../model/turn.js";
import { deliveryOf } from "../stop.js";

/**
 * Alerts: no connection, a stop, an undelivered stop; and, as polite announcements, the robot's
 * sentences.
 * @param {HTMLElement} element a region that interrupts
 * @param {HTMLElement} polite a region that waits
 * @param {{link: any, store: any, t: (key: string, args?: object) => string, isParticipant?: boolean}} context
 *   a participant has no Resume, and gets instructions
 */
export function mountAlarm(element, polite, { link, store, t, isParticipant = false }) {
  const text = h("p", { class: "alarm-text" });
  const act = h("button", { type: "button", class: "alarm-act", onclick: () => link.reconnect() });
  const bar = h("div", { class: "alarm-bar", hidden: true }, icon("down", 22), text, act);
  element.append(bar);
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
    const { is, why, atRest } = store.get("now");
    const delivery = deliveryOf(store);
    if (delivery === "unsent") return show("undelivered");
    if (why && why !== "connecting") return show(why);
    if (delivery === "unconfirmed") {
      const late = store.get("motion")?.unconfirmed?.why ?? "silent";
      return show("unconfirmed", { why: t(`alarm.why.${late}`) });
    }
    const key = is === "stopped" && atRest ? (isParticipant ? "participant" : "stopped") : "";
    if (key !== shown) show(key);
  };
  store.subscribe(["now", "link", "stop", "motion"], look);

  let turn = "";
  store.subscribe("now", (now) => {
    const { key, tone } = banner(now);
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
