// @ts-check
import { keepDelivery } from "../delivery.js";
import { eachFrame, h, keyed, setAttribute, setText } from "../dom.js";
import { keptLanguage, tabStorage } from "../kept.js";
import { sessionId } from "../link/session.js";
import { connect } from "../link.js";
import { countOf, rankListed, readable } from "../model/ranking.js";
import { keepNow } from "../now.js";
import { keep, Store } from "../store.js";
import { chooseLanguage, loadStrings, t, translate } from "../strings.js";
import { mountPart } from "../views/part.js";
import { mountTurn } from "../views/turn.js";
import { lastHeard, sentence, sizeOf } from "./model.js";

/** Most bars: they are large. */
const BARS_MAX = 6;
/** Sections that the sentence is made of. */
const SHOWN = ["now", "dialogue", "scene", "delivery"];

/** @param {string} id @returns {HTMLElement} */
const at = (id) => /** @type {HTMLElement} */ (document.getElementById(id));

const store = new Store();
// A screen has the rights of a viewer, and never gets control.
const link = connect({
  session: sessionId(tabStorage()),
  role: "screen",
  lastLine: () => store.resumeAfter,
});
keep(store, link);
keepDelivery({ link, store });
await loadStrings(chooseLanguage(location.search, keptLanguage(), navigator.languages));
translate(document);
store.subscribe("welcome", ({ group }) => {
  document.title = `whichone · ${group}`;
});

const context = { link, store, t };
keepNow(context);
mountTurn(at("turn"), context);
mountPart(at("arm"), () => import("../arm/index.js"), "mountArm", context);

const drawWords = eachFrame(() => {
  const shown = Object.fromEntries(SHOWN.map((name) => [name, store.get(name)]));
  const words = sentence(/** @type {any} */ (shown), t);
  setText(at("sentence"), words);
  at("sentence").style.setProperty("--size", String(sizeOf(words)));
  const heard = lastHeard(store.get("lines"));
  setText(at("heard"), heard ? t("audience.heard", { text: heard }) : "");
});
store.subscribe([...SHOWN, "lines"], drawWords);

/** Names in the order that is shown. @type {string[]} */
let order = [];
const drawBars = eachFrame(() => {
  const scene = store.get("scene");
  if (!scene) return;
  const belief = scene.objects.map(({ name }) => store.get("belief")?.[name] ?? 0);
  const ranked = rankListed(order, scene.objects, belief);
  order = ranked.map((n) => scene.objects[n].name);
  const item = (n) => ({ id: `${scene.key}.${scene.objects[n].name}`, n, p: belief[n] });
  const items = ranked.slice(0, BARS_MAX).map(item);
  const best = Math.max(...belief, 0);
  const make = () =>
    h(
      "li",
      {},
      h("span", { class: "audience-name" }),
      h("span", { class: "audience-bar", "aria-hidden": "true" }, h("span", {})),
      h("span", { class: "audience-share" }),
    );
  keyed(
    at("bars"),
    items,
    ({ id }) => id,
    make,
    (node, { n, p }) => {
      const [name, bar, share] = node.children;
      const { sign, share: part } = readable(p);
      setText(name, scene.objects[n].label ?? scene.objects[n].name);
      setText(share, sign + t.percent(part));
      bar.firstElementChild.style.setProperty("inline-size", `${100 * p}%`);
      setAttribute(node, "data-best", p === best && p > 1.5 / countOf(scene));
    },
  );
});
store.subscribe(["scene", "belief"], drawBars);
document.documentElement.dataset.ready = "";
