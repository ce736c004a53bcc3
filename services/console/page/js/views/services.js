// @ts-check
import { eachFrame, h, keyed, setAttribute, setText } from "../dom.js";
import { icon } from "../icons.js";
import { noteOf, stateOf, tone } from "../model/health.js";
import { whoControls } from "../model/turn.js";
import { attempt } from "./attempt.js";

/**
 * The services: name, state, restarts, and a restart for who is in control.
 * @param {HTMLElement} element
 * @param {{link: any, store: any, t: any}} context
 */
export function mountServices(element, context) {
  const { link, store, t } = context;
  const list = h("ul", { class: "service-list", "aria-label": t("services.label") });
  const empty = h("p", { class: "empty", text: t("services.none") });
  element.append(list, empty);

  const make = ({ name }) => {
    const restart = () => attempt(link.do("restart_service", { service: name }), context);
    const label = t("services.restart_one", { name });
    const button = { type: "button", class: "small restart", "aria-label": label, title: label };
    return h(
      "li",
      { class: "service" },
      h("span", { class: "service-lamp", "aria-hidden": "true" }),
      h("span", { class: "service-name", text: name }),
      h("span", { class: "service-state" }),
      h("span", { class: "service-note" }),
      h("button", { ...button, onclick: restart }, icon("again", 16)),
    );
  };
  const update = (node, service) => {
    const [, , state, note, button] = node.children;
    const now = stateOf(service);
    setAttribute(node, "data-state", tone(now));
    setText(state, t(`service.${now}`));
    const restarts = service.restarts > 0 ? t("services.restarts", { n: service.restarts }) : "";
    setText(note, [noteOf(service, t), restarts].filter(Boolean).join(" · "));
    button.disabled = whoControls(store.get("control"), store.get("welcome")) !== "mine";
  };
  const draw = eachFrame(() => {
    const services = store.get("group")?.services ?? [];
    empty.hidden = services.length > 0;
    keyed(list, services, (service) => service.name, make, update);
  });
  store.subscribe(["group", "control", "welcome"], draw);
  draw();
}
