// @ts-check
/** By how much an object must be more probable than another to come before it. */
const MARGIN = 0.004;

/**
 * The order of the cards: by probability, but a card only overtakes others that it leaves behind by
 * a margin, so that small changes move nothing.
 * @param {number[]} before objects in the order that is shown now
 * @param {number[]} belief probability of each object
 * @returns {number[]} objects in the order to show
 */
export function rank(before, belief) {
  const kept = before.filter((object) => object < belief.length);
  const shown = new Set(kept);
  const all = [...kept, ...[...belief.keys()].filter((object) => !shown.has(object))];
  /** @type {number[]} */
  const order = [];
  for (const object of all) {
    const place = order.findIndex((other) => belief[object] > belief[other] + MARGIN);
    if (place < 0) order.push(object);
    else order.splice(place, 0, object);
  }
  return order;
}

/**
 * The order of a scene's objects, of which the server may list others at each time.
 * @param {string[]} before names in the order that is shown now
 * @param {{name: string}[]} objects those that are listed
 * @param {number[]} belief probability of each
 * @returns {number[]} objects in the order to show
 */
export function rankListed(before, objects, belief) {
  const places = new Map(objects.map(({ name }, place) => [name, place]));
  return rank(
    before.map((name) => places.get(name) ?? -1).filter((place) => place >= 0),
    belief,
  );
}

/**
 * The cards shown if there are too many: the first ones and those that matter in any case.
 * @param {number[]} order
 * @param {number[]} belief
 * @param {number} most
 * @param {Set<number>} pinned objects that are shown wherever they stand
 * @returns {{shown: number[], others: number, rest: number}} `rest`: the others' probability together
 */
export function likely(order, belief, most, pinned) {
  if (order.length <= most + 1) return { shown: order, others: 0, rest: 0 };
  const places = Math.max(1, most - order.slice(most).filter((one) => pinned.has(one)).length);
  const shown = order.filter((object, place) => place < places || pinned.has(object));
  const among = new Set(shown);
  const left = order.filter((object) => !among.has(object));
  const rest = left.reduce((sum, object) => sum + (belief[object] ?? 0), 0);
  return { shown, others: left.length, rest };
}

/**
 * Number of objects in the scene, listed or not.
 * @param {any} scene
 * @returns {number}
 */
export const countOf = (scene) => scene?.count ?? scene?.objects.length ?? 0;

/**
 * The objects of a large scene that the server does not list: they are unlikely.
 * @param {any} scene
 * @param {any} dialogue
 * @returns {{count: number, share: number}} `share`: their probability together
 */
export function unlistedOf(scene, dialogue) {
  const count = Math.max(0, countOf(scene) - scene.objects.length);
  if (count === 0 || !dialogue?.belief) return { count, share: 0 };
  const listed = Object.values(dialogue.belief).reduce((sum, p) => sum + p, 0);
  return { count, share: Math.max(0, 1 - listed - (dialogue.absent ?? 0)) };
}

/**
 * The most probable objects in the scene's order, so that each keeps its place.
 * @param {number[]} belief
 * @param {number} most
 * @returns {number[]}
 */
export function strip(belief, most) {
  const likeliest = [...belief.keys()].sort((a, b) => belief[b] - belief[a] || a - b);
  return likeliest.slice(0, most).sort((a, b) => a - b);
}

/**
 * A probability as a share that is read off easily: never "100 %" or "0 %" unless exact.
 * @param {number} p
 * @returns {{sign: ""|"<"|">", share: number}}
 */
export function readable(p) {
  if (p > 0 && p < 0.005) return { sign: "<", share: 0.01 };
  if (p < 1 && p > 0.995) return { sign: ">", share: 0.99 };
  return { sign: "", share: Math.round(p * 100) / 100 };
}

/**
 * A probability in words: "17%", ">99%".
 * @param {number} p
 * @param {any} t
 * @returns {string}
 */
export function shareWords(p, t) {
  const { sign, share } = readable(p);
  return sign + t.percent(share);
}

/**
 * The objects that something happens to. Without a connection nothing is known of them.
 * @param {any} scene
 * @param {import("../now.js").Now} now
 * @param {any} world
 * @returns {Map<number, "held"|"picking"|"halted"|"pointed"|"delivered">}
 */
export function marks(scene, now, world) {
  const found = new Map();
  if (now.is === "disconnected") return found;
  const place = (name) => scene.objects.findIndex((object) => object.name === name);
  world?.objects?.forEach((pose, object) => {
    if (pose === null) found.set(object, "delivered");
  });
  const mark = (name, as) => place(name) >= 0 && found.set(place(name), as);
  if (now.question?.type === "point") mark(now.question.object, "pointed");
  const { phase, object } = now.order ?? { phase: "idle" };
  if (["holding", "returning"].includes(phase)) mark(object, "held");
  else if (!["idle", "done"].includes(phase)) {
    mark(object, now.is === "stopped" ? "halted" : "picking");
  }
  const held = typeof world?.held === "string" ? place(world.held) : world?.held;
  if (Number.isInteger(held) && held >= 0) found.set(held, "held");
  return found;
}

/** Least heights of a card, pixels: with all its words, with them closely set. */
const ROOMY_PX = 80;
const MEDIUM_PX = 66;

/**
 * Returns the density of the cards.
 * @param {number} cards
 * @param {number|null} heightPx the height for all of them; null: as much as they want
 * @returns {"roomy"|"medium"|"dense"} dense: one line each
 */
export function density(cards, heightPx) {
  if (heightPx === null) return cards <= 7 ? "medium" : "dense";
  const each = heightPx / Math.max(1, cards);
  if (each >= ROOMY_PX) return "roomy";
  return each >= MEDIUM_PX ? "medium" : "dense";
}
