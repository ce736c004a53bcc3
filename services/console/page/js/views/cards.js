// @ts-check
import { calm, eachFrame, h, keyed, setAttribute, setText } from "../dom.js";
import {
  countOf,
  density,
  likely,
  marks,
  rankListed,
  shareWords,
  unlistedOf,
} from "../model/ranking.js";
import { makeCard, updateCard } from "./card.js";

/** Most cards that are shown until all are requested. */
const MOST = 12;
/** Most cards that are shown at all. */
const ALL_MOST = 150;
/** Matches pages that fill the window and do not scroll. */
const FIXED =
  "(min-width: 1101px) and (min-height: 640px), (max-width: 640px) and (min-height: 780px), (min-width: 641px) and (max-width: 1100px)";

/**
 * The objects with the robot's belief, the likely ones first. The operator says one by a press.
 * @param {HTMLElement} element
 * @param {{link: any, store: any, t: any, readOnly?: boolean, grows?: boolean}} context `grows`: the list is as
 *   tall as its cards
 */
export function mountCards(element, context) {
  const { store, t } = context;
  const list = h("ol", { class: "card-list" });
  const absent = h("p", { class: "absent", hidden: true });
  const more = h("button", { type: "button", class: "more", hidden: true });
  const empty = h("p", { class: "empty" });
  element.append(list, absent, more, empty);
  // The cards scroll: also by keys.
  element.tabIndex = 0;
  element.setAttribute("role", "group");
  element.setAttribute("aria-labelledby", "objects-heading");
  /** Names in the order that is shown. @type {string[]} */
  let order = [];
  let stands = "";
  let sceneKey = null;
  let all = false;
  more.addEventListener("click", () => {
    all = !all;
    draw();
  });

  /** Height available for the cards, if the page does not scroll. */
  let height = null;
  const fixed = matchMedia(context.grows ? "not all" : FIXED);
  new ResizeObserver(() => {
    const now = fixed.matches ? element.clientHeight : null;
    if (now === height) return;
    height = now;
    draw();
  }).observe(element);

  const draw = eachFrame(() => {
    const scene = store.get("scene");
    const dialogue = store.get("dialogue");
    empty.hidden = Boolean(scene?.objects.length);
    setText(empty, t("objects.none"));
    if (!scene) return;
    if (scene.key !== sceneKey) {
      keyed(list, [], String, () => h("li"));
      order = [];
      sceneKey = scene.key;
    }
    const believed = store.get("belief") ?? dialogue?.belief;
    const belief = scene.objects.map(({ name }) => believed?.[name] ?? 0);
    const now = store.get("now");
    const marked = marks(scene, now, store.get("world"));
    const ranked = rankListed(order, scene.objects, belief);
    order = ranked.map((i) => scene.objects[i].name);
    const pinned = new Set([...marked].filter(([, mark]) => mark !== "delivered").map(([i]) => i));
    const { shown, others, rest } = likely(ranked, belief, all ? ALL_MOST : MOST, pinned);
    const unlisted = unlistedOf(scene, dialogue);
    const best = belief.reduce((top, p) => Math.max(top, p), 0);
    const mine = !context.readOnly && now.who === "mine";
    const items = shown.map((i) => ({
      index: i,
      object: scene.objects[i],
      p: belief[i],
      mark: marked.get(i) ?? null,
      sayable: mine && marked.get(i) !== "delivered",
      leads: best > 1.5 / countOf(scene) && belief[i] >= best - 1e-9,
    }));
    setAttribute(list, "data-density", density(items.length, height));
    const asked = askedValue(now);
    const make = (item) => makeCard(item, scene, context);
    const update = (node, item) => updateCard(node, item, asked, t);
    const change = () => keyed(list, items, (item) => item.object.name, make, update);
    const standing = items.map(({ object }) => object.name).join();
    if (standing === stands || calm()) change();
    else glide(list, change);
    stands = standing;
    const left = others + unlisted.count;
    more.hidden = left === 0 && !all;
    // Objects that the server does not list cannot be shown.
    more.disabled = others === 0 && !all;
    const args = { n: left, share: t.percent(rest + unlisted.share, 1) };
    setText(more, all && others === 0 ? t("objects.fewer") : t("objects.more", args));
    absent.hidden = !(dialogue?.absent > 0);
    setText(absent, t("objects.absent", { share: shareWords(dialogue?.absent ?? 0, t) }));
  });
  store.subscribe(["scene", "dialogue", "world", "belief", "now"], draw);
  draw();
}

/** The value that the standing question is about. */
function askedValue({ question }) {
  if (question?.type === "attr") return { attribute: question.attribute, value: question.value };
  return ["which", "choice"].includes(question?.type)
    ? { attribute: question.attribute, value: null }
    : null;
}

/** Changes the list; cards that stand elsewhere then glide there. All is read before it is written. */
function glide(list, change) {
  const tops = new Map([...list.children].map((node) => [node, node.offsetTop]));
  change();
  const moves = [...list.children].map((node) => [node, (tops.get(node) ?? NaN) - node.offsetTop]);
  for (const [node, by] of moves) {
    if (!by) continue;
    const from = { transform: `translateY(${by}px)` };
    node.animate([from, { transform: "none" }], {
      duration: 450,
      easing: "cubic-bezier(.3,.8,.3,1)",
    });
  }
}
