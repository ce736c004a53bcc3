// @ts-check
import { eachFrame, h, setAttribute, setText } from "../dom.js";
import { icon } from "../icons.js";
import { whoControls } from "../model/turn.js";
import { attempt } from "./attempt.js";

/**
 * Who is in control, how many watch, and how to take control or give it away.
 * @param {HTMLElement} element
 * @param {{link: any, store: any, t: (key: string, args?: object) => string}} context
 */
export function mountControl(element, context) {
  const { link, store, t } = context;
  const who = h("span", { class: "control-who" });
  const mark = h("span", { class: "control-mark" }, icon("person", 18));
  const viewers = h("span", { class: "control-viewers" });
  const take = button("control.take", () => attempt(link.do("take_control"), context));
  const give = button("control.give", () =>
    attempt(link.do("give_control", { viewer: store.get("control")?.asked_by }), context),
  );
  const keepIt = button("control.keep", () => attempt(link.do("keep_control"), context));
  const release = button("control.release", () =>
    attempt(link.do("give_control", { viewer: null }), context),
  );
  element.append(
    mark,
    h("span", { class: "control-text" }, who, viewers),
    take,
    give,
    keepIt,
    release,
  );

  function button(key, onclick) {
    return h("button", { type: "button", class: "small", text: t(key), hidden: true, onclick });
  }

  const draw = eachFrame(() => {
    const control = store.get("control");
    const mine = whoControls(control, store.get("welcome"));
    const asked = mine === "mine" && control.asked_by ? control.asked_by : null;
    const name = control?.name || control?.operator || "";
    setAttribute(element, "data-who", mine);
    setText(who, asked ? t("control.asks", { viewer: asked }) : t(`control.${mine}`, { name }));
    const n = control?.viewers ?? 0;
    setText(viewers, control ? t("control.viewers", { n }) : "");
    take.hidden = mine !== "free" && mine !== "theirs";
    setText(take, t(mine === "theirs" ? "control.ask" : "control.take"));
    give.hidden = keepIt.hidden = !asked;
    release.hidden = mine !== "mine" || asked !== null || n < 2;
  });
  store.subscribe(["control", "welcome", "link"], draw);
  draw();
}
