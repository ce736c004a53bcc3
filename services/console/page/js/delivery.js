// @ts-check
// The object handed over, while it can be refused: the store's section `delivery`. The section
// `belief` is the present belief; until that time is over, the belief at the end.

/** Longest delay of a timer, milliseconds. */
const TIMER_MAX_MS = 2 ** 31 - 1;

/**
 * @typedef {{interaction: number, object: any, leftMs: number}} Delivery
 */

/**
 * The delivery that can be refused now.
 * @param {any} dialogue
 * @param {any} scene
 * @param {number} nowMs the server's time
 * @param {number|undefined} settled the interaction whose delivery the operator has confirmed
 * @returns {Delivery|null}
 */
export function deliveryOf(dialogue, scene, nowMs, settled) {
  const open = dialogue?.interaction === 0 ? dialogue.refusable : null;
  if (!open || open.interaction === settled || open.until_ms <= nowMs) return null;
  const object = scene?.objects.find(({ name }) => name === open.object);
  const { interaction, until_ms } = open;
  return object ? { interaction, object, leftMs: until_ms - nowMs } : null;
}

/**
 * Keeps the sections `delivery` and `belief`. Setting `settled` to its interaction ends it for this page.
 * @param {{link: any, store: any}} context
 */
export function keepDelivery({ link, store }) {
  let timer = 0;
  const look = () => {
    clearTimeout(timer);
    const [dialogue, scene] = [store.get("dialogue"), store.get("scene")];
    const delivery = deliveryOf(dialogue, scene, link.serverNow(), store.get("settled"));
    if (delivery) timer = setTimeout(look, Math.min(delivery.leftMs, TIMER_MAX_MS));
    if (delivery || store.get("delivery")) store.set("delivery", delivery);
    if (!delivery || !store.get("belief")) store.set("belief", dialogue?.belief ?? null);
  };
  store.subscribe(["dialogue", "scene", "settled"], look);
}
