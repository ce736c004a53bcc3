// @ts-check
import { LinkError } from "../link.js";

/**
 * Acts in control of the robot, as ending another's participation requires; control is given back
 * afterwards. The operator may refuse it.
 * @template T
 * @param {{link: any, store: any, t: (key: string) => string}} context
 * @param {() => Promise<T>} act
 * @returns {Promise<T>}
 */
export async function inControl({ link, store, t }, act) {
  const me = store.get("welcome")?.viewer;
  const before = store.get("control")?.operator ?? null;
  if (before === me) return act();
  const { granted } = await link.do("take_control");
  if (!granted) await handover(store, me, t);
  try {
    return await act();
  } finally {
    // An operator that has gone meanwhile needs it no more.
    if (before !== null) link.do("give_control", { viewer: before }).catch(() => {});
  }
}

/** Waits until control is handed over. */
function handover(store, me, t) {
  let isAsked = false;
  return new Promise((resolve, reject) => {
    const stop = store.subscribe("control", ({ operator, asked_by }) => {
      const isOver = operator === me || (isAsked && asked_by !== me);
      isAsked ||= asked_by === me;
      if (!isOver) return;
      // Not before `subscribe` has returned.
      queueMicrotask(() => stop());
      if (operator === me) resolve(undefined);
      else reject(new LinkError("refused", t("control.kept")));
    });
  });
}
