// @ts-check
import { eachFrame, h, setAttribute, setText } from "../dom.js";
import { health } from "../model/health.js";
import { duration } from "./duration.js";
import { mountEvents } from "./events.js";
import { mountLatency } from "./latency.js";
import { mountServices } from "./services.js";

/**
 * Matches pages with enough room, or with nothing next to it, in which everything is shown at once.
 */
const ROOMY = "(min-height: 1300px), (max-width: 1100px)";

/**
 * In a line how the group is doing; opened, its services, how soon it answers, and events.
 * @param {HTMLElement} element
 * @param {{link: any, store: any, t: any}} context
 */
export function mountHealth(element, context) {
  const { store, t } = context;
  const lamp = h("span", { class: "service-lamp", "aria-hidden": "true" });
  const words = h("span", { class: "health-words" });
  const answer = h("span", { class: "health-answer" });
  const services = h("div", { class: "services" });
  const latency = h("div", { class: "latency" });
  const events = h("div", { class: "events" });
  const summary = h("summary", {}, lamp, words, answer);
  const details = h("details", { class: "health" }, summary, services, latency, events);
  details.open = matchMedia(ROOMY).matches;
  element.append(details);
  mountServices(services, context);
  mountLatency(latency, context);
  mountEvents(events, context);

  const draw = eachFrame(() => {
    const isStale = store.get("now").is === "disconnected";
    const now = health(store.get("group")?.services, isStale);
    setAttribute(summary, "data-state", now.tone);
    setText(words, t(now.key, now.args));
    const total = store.get("latency")?.p50?.total_ms;
    const known = !isStale && typeof total === "number" && store.get("latency").count > 0;
    setText(answer, known ? t("health.answers", { time: duration(total, t) }) : "");
  });
  store.subscribe(["group", "latency", "now"], draw);
  draw();
}
