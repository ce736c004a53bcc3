// @ts-check
import { eachFrame, h, keyed, setAttribute, setText } from "../dom.js";
import { icon } from "../icons.js";
import { actOf, noteOf, tone } from "../model/health.js";
import { attempt } from "./attempt.js";

/** Pictures of buttons' actions. */
const ICONS = { restart: "again", retry: "again", start: "play", release: "play" };

/**
 * The services: name, state, restarts, and a button that starts them again for who is in control.
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
    const button = { type: "button", class: "small restart" };
    return h(
      "li",
      { class: "service" },
      h("span", { class: "service-lamp", "aria-hidden": "true" }),
      h("span", { class: "service-name", text: name }),
      h("span", { class: "service-state" }),
      h("span", { class: "service-note" }),
      h("button", { ...button, onclick: restart }),
    );
  };
  const update = (node, service) => {
    const [, , state, note, button] = node.children;
    const now = store.get("now");
    const isStale = now.is === "disconnected";
    setAttribute(node, "data-state", isStale ? "unknown" : tone(service.state));
    setText(state, t(`service.${isStale ? "unknown" : service.state}`));
    const act = actOf(service.state);
    const label = t(`services.act.${act}`, { name: service.name });
    setAttribute(button, "aria-label", label);
    setAttribute(button, "title", label);
    if (button.dataset.act !== act) button.replaceChildren(icon(ICONS[act], 16));
    button.dataset.act = act;
    const restarts = service.restarts > 0 ? t("services.restarts", { n: service.restarts }) : "";
    setText(note, [noteOf(service, t), restarts].filter(Boolean).join(" · "));
    button.disabled = now.who !== "mine";
  };
  const draw = eachFrame(() => {
    const services = store.get("group")?.services ?? [];
    empty.hidden = services.length > 0;
    keyed(list, services, (service) => service.name, make, update);
  });
  store.subscribe(["group", "now"], draw);
  draw();
}
