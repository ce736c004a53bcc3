// @ts-check
import { nearest } from "./geometry.js";

/**
 * State of the chosen object, in words: reach, clearance, and how the robot names it.
 * @param {import("./session.js").SceneSession} session
 * @param {any} t
 * @returns {string}
 */
export function thingState(session, t) {
  const { object, chosen, document, findings } = session;
  if (!object || chosen === null) return "";
  const words = findings.words[chosen];
  const said = words ? t("scene.state.words", { words }) : "";
  if (!object.xyz) return [t("scene.state.unplaced"), said].filter(Boolean).join(" · ");
  return [reachWords(session, t), gapWords(nearest(document.objects, chosen), document, t), said]
    .filter(Boolean)
    .join(" · ");
}

function reachWords({ reach, object }, t) {
  const limb = reach?.at(object.xyz[0], object.xyz[1]);
  if (limb === undefined) return t("scene.state.unknown");
  return limb === null ? t("scene.state.out") : t("scene.state.in", { limb });
}

function gapWords(near, { objects }, t) {
  if (!near) return "";
  const [mm, name] = [Math.round(near.gap * 1e3), objects[near.other].name];
  return t(near.gap === 0 ? "scene.state.over" : "scene.state.gap", { mm, name });
}
