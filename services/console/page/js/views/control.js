// @ts-check
import { eachFrame, h, setAttribute, setText } from "../dom.js";
import { icon } from "../icons.js";
import { myPages } from "../mypages.js";
import { attempt } from "./attempt.js";

/**
 * Shows who is the operator and how many are watching, and takes or gives up control.
 * @param {HTMLElement} element
 * @param {{link: any, store: any, t: any}} context
 */
export function mountControl(element, context) {
  const { link, store, t } = context;
  const pages = myPages(context);
  const who = h("span", { class: "control-who" });
  const viewers = h("span", { class: "control-viewers" });
  const take = button(() => {
    if (pages.isMine(store.get("control")?.operator ?? null)) pages.fetch();
    else attempt(link.do("take_control"), context);
  });
  const give = button(() => {
    attempt(link.do("give_control", { viewer: store.get("control")?.asked_by }), context);
  });
  const keep = button(() => attempt(link.do("keep_control"), context));
  setText(give, t("control.give"));
  setText(keep, t("control.keep"));
  const mark = h("span", { class: "control-mark" }, icon("person", 18));
  element.append(mark, h("span", { class: "control-text" }, who, viewers), take, give, keep);

  function button(onclick) {
    return h("button", { type: "button", class: "small", hidden: true, onclick });
  }

  let tick = 0;
  const draw = eachFrame(() => {
    clearTimeout(tick);
    const control = store.get("control");
    const now = store.get("now");
    const isStale = now.is === "disconnected" && now.why !== "connecting";
    const is = now.who;
    const elsewhere = is === "theirs" && pages.isMine(control.operator);
    const asked = is === "mine" && control.asked_by ? control.asked_by : null;
    const name = control?.name || t("control.someone");
    setAttribute(element, "data-who", is);
    const key = elsewhere ? "elsewhere" : isStale ? "offline" : is;
    setText(
      who,
      asked
        ? t("control.asks", { viewer: control.asked_name || t("control.someone") })
        : t(`control.${key}`, { name }),
    );
    const left = control?.expires_ms
      ? Math.ceil((control.expires_ms - link.serverNow()) / 1000)
      : 0;
    const n = control?.viewers ?? 0;
    const soon = (asked || is === "asked") && left > 0;
    if (soon) tick = setTimeout(draw, 500);
    const below = soon ? t("control.in", { s: left }) : t("control.viewers", { n });
    setText(viewers, control && !isStale ? below : "");
    take.hidden = !["free", "theirs", "away"].includes(is);
    setText(take, t(elsewhere ? "control.here" : is !== "free" ? "control.ask" : "control.take"));
    give.hidden = keep.hidden = !asked;
  });
  store.subscribe(["control", "now"], draw);
}
