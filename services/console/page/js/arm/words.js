// @ts-check
import { countOf } from "../model/ranking.js";

/** Ends of a pick that the picture says in words. */
const OUTCOMES = [
  "delivered",
  "unreachable",
  "interrupted",
  "cancelled",
  "missed",
  "blocked",
  "put_back",
  "vanished",
  "kept",
];
/** Ends of an order with other words if the object was to be put back. */
const OUTCOMES_OF_PUT_BACK = ["unreachable", "cancelled", "missed"];

/**
 * Describes the arm's state in one sentence.
 * @param {import("../now.js").Now} now
 * @param {any} arm section `arm`
 * @param {any} scene section `scene`
 * @param {any} trajectory section `trajectory`
 * @param {(key: string, args?: object) => string} t
 * @returns {string}
 */
export function armWords(now, arm, scene, trajectory, t) {
  if (now.why) return t("arm.disconnected");
  if (!arm) return t("arm.unknown");
  const object = labelOf(arm.object, scene) ?? t("arm.object");
  if (arm.stopped) return t("arm.stopped");
  const hindrance = arm.hindrance && arm.hindrance !== "none" ? arm.hindrance : null;
  if (hindrance) return t("arm.hindered", { what: t(`arm.hindrance.${hindrance}`) });
  if (arm.phase && arm.phase !== "idle" && arm.phase !== "done") {
    const task = arm.task === "put_back" ? "arm.put_back" : "arm.phase";
    const what = t(`${task}.${arm.phase}`, { object });
    const n = Math.round(arm.remaining_s ?? 0);
    return n > 0 ? t("arm.with_time", { what, n }) : what;
  }
  if (arm.aimed) return t("arm.aimed");
  if (arm.moving) return t(trajectory && !trajectory.pick ? "arm.moving" : "arm.returning");
  // How an earlier dialogue ended is not news in this one.
  if (now.order && arm.phase === "done" && OUTCOMES.includes(arm.outcome)) {
    const own = arm.task === "put_back" && OUTCOMES_OF_PUT_BACK.includes(arm.outcome);
    return t(own ? `arm.put_back.${arm.outcome}` : `arm.outcome.${arm.outcome}`, { object });
  }
  return t("arm.resting");
}

/**
 * Short words for an object.
 * @param {string|number|null|undefined} object its name, or its place in the scene
 * @param {any} scene section `scene`
 */
export function labelOf(object, scene) {
  const index = indexOf(object, scene);
  return index === null ? null : (scene.objects[index].label ?? scene.objects[index].name);
}

/**
 * The place of an object in the scene.
 * @param {string|number|null|undefined} object its name, or its place
 * @param {any} scene section `scene`
 * @returns {number|null}
 */
export function indexOf(object, scene) {
  if (object === null || object === undefined || !scene) return null;
  const index = scene.objects.findIndex(({ name }) => name === object);
  if (index >= 0) return index;
  return typeof object === "number" && object < scene.objects.length ? object : null;
}

/**
 * Describes the robot's belief in each object and whether it asks about it.
 * @param {Record<string, number>|null|undefined} belief section `belief`, as the list shows it
 * @param {any} pending question
 * @param {any} scene section `scene`
 * @returns {{belief: number|null, best: boolean, asked: boolean}[]} in the scene's order
 */
export function thoughtsOf(belief, question, scene) {
  const probabilities = Object.values(belief ?? {});
  const most = Math.max(...probabilities, 0);
  const even = probabilities.length ? 1.02 / countOf(scene) : 1;
  return (scene?.objects ?? []).map((object) => ({
    belief: belief?.[object.name] ?? null,
    // While all are equally likely, none is the most likely.
    best: belief?.[object.name] === most && most > even,
    asked: question?.object === object.name || isAsked(object, question),
  }));
}

function isAsked(object, question) {
  if (question?.type !== "attr") return false;
  return object.attributes?.[question.attribute] === question.value;
}
