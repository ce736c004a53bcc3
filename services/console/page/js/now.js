// @ts-check
// The state, as far as this page knows: the store's section `now`, from which every view draws. No view
// judges for itself whether the robot is stopped, out of reach, or at work.

import { tone } from "./model/health.js";
import { whoControls } from "./model/turn.js";

/** A connection that is back sooner changes nothing that is seen, milliseconds. */
const GRACE_MS = 1_200;
/** Services that the dialogue needs. */
const NEEDED = ["speech", "grounding", "policy", "arm"];
/** Phases of an order that is not under way. */
const AT_REST = ["idle", "done"];

/**
 * @typedef {object} Now
 * @property {"disconnected"|"stopped"|"held"|"fetching"|"asking"|"idle"} is the gravest that holds
 * @property {"connecting"|"offline"|"replaced"|"gave_way"|null} reason for a missing connection
 * @property {boolean} atRest a stop is in force, and no joint moves
 * @property {{name: string, state: string}|null} service cause of a `held` robot
 * @property {boolean} moves the arm is known to move
 * @property {any} order the arm's section, if it is of the present dialogue
 * @property {string|null} aim name of the object that is fetched, or will be
 * @property {any} question the pending question, or null
 * @property {string} turn state of the section `turn`
 * @property {ReturnType<typeof whoControls>} who is in control
 */

/**
 * Derives the state from the sections.
 * @param {{get: (section: string) => any}} store
 * @param {boolean} isLost there has been no connection for longer than is worth a word
 * @returns {Now}
 */
export function nowOf(store, isLost) {
  const [arm, dialogue, turn] = ["arm", "dialogue", "turn"].map((name) => store.get(name));
  const why = gapOf(store.get("link")?.state, turn, isLost);
  const order = orderOf(arm, dialogue);
  const question = standing(dialogue);
  const aim = aimOf(order, dialogue);
  const isStopped = arm?.stopped === true;
  const is = why
    ? "disconnected"
    : isStopped
      ? "stopped"
      : turn.state === "down"
        ? "held"
        : aim
          ? "fetching"
          : question
            ? "asking"
            : "idle";
  return {
    is,
    why,
    atRest: is === "stopped" && arm.moving !== true,
    service: is === "held" ? missing(store.get("group")?.services) : null,
    moves: why === null && arm?.moving === true,
    order: why ? null : order,
    aim,
    question: question ?? null,
    turn: turn?.state ?? "",
    who: why ? "unknown" : whoControls(store.get("control"), store.get("welcome")),
  };
}

/** Why the robot's state is unknown, or null. */
function gapOf(link, turn, isLost) {
  if (link === "replaced" || link === "gave_way") return link;
  if (isLost) return "offline";
  return turn ? null : "connecting";
}

/** The arm's section, unless its subject is over: an order of an earlier dialogue. */
function orderOf(arm, dialogue) {
  if (!arm?.object) return null;
  const inHand = dialogue?.interaction || dialogue?.last?.interaction;
  return isUnderWay(arm) || arm.interaction === inHand ? arm : null;
}

/** @param {any} arm */
const isUnderWay = (arm) => !AT_REST.includes(arm?.phase ?? "idle");

/** The object being fetched: by the arm, or by the decision that it has not taken yet. */
function aimOf(order, dialogue) {
  if (isUnderWay(order)) return order.object;
  const decided = dialogue?.interaction > 0 && dialogue.decision === "pick";
  if (!decided) return null;
  return order?.object ?? mostLikely(dialogue.belief);
}

function mostLikely(belief) {
  const all = Object.entries(belief ?? {});
  return all.reduce((best, one) => (one[1] > best[1] ? one : best), ["", -1])[0] || null;
}

/** The question that waits for an answer, also if no request is open. */
function standing(dialogue) {
  const { question, decision } = dialogue ?? {};
  if (!question || question.type === "none") return null;
  return decision === "pick" || decision === "cancel" ? null : question;
}

/** The first service that the dialogue needs and that is not ready; a silent arm if all are. */
function missing(services) {
  const all = services ?? [];
  const needed = all.filter(({ name }) => NEEDED.includes(name));
  const found = needed.find(({ state }) => tone(state) !== "good");
  return found ? { name: found.name, state: found.state } : { name: "arm", state: "unknown" };
}

const SECTIONS = ["link", "turn", "arm", "dialogue", "group", "control", "welcome"];

/**
 * Keeps the section `now`; the document's root has `data-stale` if the view may be old. To be called
 * before any view is mounted.
 * @param {{store: any}} context
 * @param {{toggleAttribute: (name: string, on: boolean) => void}} [root]
 */
export function keepNow({ store }, root = document.documentElement) {
  let timer = 0;
  let isLost = false;
  let known = "";
  const look = () => {
    const now = nowOf(store, isLost);
    const text = JSON.stringify(now);
    if (text === known) return;
    known = text;
    root.toggleAttribute("data-stale", now.is === "disconnected" && now.why !== "connecting");
    store.set("now", now);
  };
  store.subscribe("link", ({ state }) => {
    if (state === "up") {
      clearTimeout(timer);
      [timer, isLost] = [0, false];
    } else {
      timer ||= Number(
        setTimeout(() => {
          isLost = true;
          look();
        }, GRACE_MS),
      );
    }
  });
  store.subscribe(SECTIONS, look);
  look();
}
