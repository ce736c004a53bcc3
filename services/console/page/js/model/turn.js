// @ts-check
/**
 * @typedef {object} Banner
 * @property {string} key of the words: `turn.KEY`, with `turn.KEY.more` below
 * @property {"person"|"robot"|"arm"|"stopped"|"down"|"idle"} tone
 * @property {string} icon
 */

/** Looks of each state of the turn. @type {Record<string, [string, Banner["tone"], string]>} */
const STATES = {
  idle: ["idle", "person", "person"],
  listening: ["listening", "person", "ear"],
  hearing: ["hearing", "person", "ear"],
  asked: ["asked", "person", "person"],
  understanding: ["understanding", "robot", "think"],
  speaking: ["speaking", "robot", "speak"],
  moving: ["moving", "arm", "arm"],
  stopping: ["stopping", "stopped", "stop"],
  stopped: ["stopped", "stopped", "stop"],
  down: ["down", "down", "down"],
};

/** States in which the sign speaks to the operator. */
const TO_OPERATOR = ["idle", "listening", "hearing", "asked", "speaking"];

/**
 * Summarises whose turn it is in one sign: the state, else the actor.
 * @param {import("../now.js").Now} now for viewers it is the operator's turn
 * @returns {Banner}
 */
export function banner(now) {
  if (now.why === "connecting") return { key: now.why, tone: "idle", icon: "think" };
  if (now.why) return { key: now.why, tone: "down", icon: "down" };
  const latched = now.is === "stopped";
  const state = latched ? (now.atRest ? "stopped" : "stopping") : now.turn;
  const [key, tone, icon] = STATES[state] ?? STATES.idle;
  const theirs = ["theirs", "asked", "away"].includes(now.who) && TO_OPERATOR.includes(key);
  return { key: theirs ? `theirs_${key}` : key, tone, icon };
}

/**
 * Returns whether this page may release the motion stop: the operator's may, but while a participant of a
 * study is in control, every page but the participant's.
 * @param {any} control
 * @param {any} welcome
 */
export function mayResume(control, welcome) {
  const isMine = whoControls(control, welcome) === "mine";
  return control?.participant ? !isMine && Boolean(welcome) : isMine;
}

/**
 * Returns whether this page may act, and who is the operator.
 * @param {{operator: string|null, away?: boolean, asked_by?: string|null}|undefined} control
 * @param {{viewer: string}|undefined} welcome
 * @returns {"mine"|"asked"|"free"|"theirs"|"away"|"unknown"} `asked`: I asked for it and wait; `away`: the
 *   operator's page is gone, and may come back
 */
export function whoControls(control, welcome) {
  if (!control || !welcome) return "unknown";
  if (control.operator === welcome.viewer) return "mine";
  if (control.operator === null) return "free";
  if (control.away) return control.asked_by === welcome.viewer ? "asked" : "away";
  return control.asked_by === welcome.viewer ? "asked" : "theirs";
}
