// @ts-check
/**
 * @typedef {object} Banner
 * @property {string} key of the words: `turn.KEY`, with `turn.KEY.more` below
 * @property {"person"|"robot"|"arm"|"stopped"|"down"|"idle"} tone
 * @property {string} icon
 */

/** Looks of each state of the turn. @type {Record<string, [string, Banner["tone"], string]>} */
const STATES = {
  idle: ["idle", "person", "ear"],
  listening: ["listening", "person", "ear"],
  hearing: ["hearing", "person", "ear"],
  asked: ["asked", "person", "ear"],
  understanding: ["understanding", "robot", "think"],
  speaking: ["speaking", "robot", "speak"],
  moving: ["moving", "arm", "arm"],
  stopping: ["stopping", "stopped", "stop"],
  stopped: ["stopped", "stopped", "stop"],
  down: ["down", "down", "down"],
};

/**
 * Returns whether the arm stands: its stop is latched, and no joint moves.
 * @param {{stopped?: boolean, moving?: boolean}|null|undefined} arm
 */
export function isStopped(arm) {
  return arm?.stopped === true && arm.moving !== true;
}

/** States in which the sign speaks to the operator. */
const TO_OPERATOR = ["idle", "listening", "hearing", "asked", "speaking"];

/**
 * Summarises whose turn it is in one sign. Without a connection nothing else is known.
 * @param {{state: string}|undefined} link
 * @param {{state: string}|undefined} turn
 * @param {{stopped?: boolean, moving?: boolean}|undefined} arm a stop outranks whose turn it is
 * @param {ReturnType<typeof whoControls>} [who] for viewers it is the operator's turn
 * @returns {Banner}
 */
export function banner(link, turn, arm, who) {
  if (link?.state === "replaced" || link?.state === "gave_way") {
    return { key: link.state, tone: "down", icon: "down" };
  }
  if (link?.state !== "up") {
    const key = link?.state === "connecting" && !turn ? "connecting" : "offline";
    return { key, tone: "down", icon: "down" };
  }
  if (!turn) return { key: "connecting", tone: "idle", icon: "think" };
  const latched = arm?.stopped === true && turn.state !== "down";
  const state = latched ? (isStopped(arm) ? "stopped" : "stopping") : turn.state;
  const [key, tone, icon] = STATES[state] ?? STATES.idle;
  const theirs = (who === "theirs" || who === "asked") && TO_OPERATOR.includes(key);
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
 * @param {{operator: string|null, name?: string, asked_by?: string|null}|undefined} control
 * @param {{viewer: string}|undefined} welcome
 * @returns {"mine"|"asked"|"free"|"theirs"|"unknown"} `asked`: I asked for it and wait
 */
export function whoControls(control, welcome) {
  if (!control || !welcome) return "unknown";
  if (control.operator === welcome.viewer) return "mine";
  if (control.operator === null) return "free";
  return control.asked_by === welcome.viewer ? "asked" : "theirs";
}
