// The states of the robot that every view of the page has to tell, each as the console says it. All of them
// come after a dialogue that has delivered another object: nothing of it may be shown as of now.

import { GOLDEN, ME } from "./fed.mjs";

/** What the dialogue before was about, and what this one is. */
export const OLD = "big metallic bowl";
export const NEW = "clear bowl";

const NAMES = GOLDEN.scene.objects.map(({ name }) => name);
const EVEN = Object.fromEntries(NAMES.map((name) => [name, 1 / NAMES.length]));
const SURE = { ...Object.fromEntries(NAMES.map((name) => [name, 0.008])), clear: 0.96 };
const pick = (object, value) => ({ action: { type: "pick", object }, value });
const services = (states) =>
  ["speech", "grounding", "policy", "arm", "console"].map((name) => ({
    name,
    state: states[name] ?? "ready",
    restarts: 0,
    why: states[name] ? "held by the operator" : null,
    says: null,
    last_exit: null,
  }));
const group = (states) => ({ services: services(states) });

const rests = {
  ...GOLDEN.arm,
  interaction: 1,
  object: "metal2",
  phase: "done",
  outcome: "delivered",
};
const moves = { ...rests, interaction: 2, object: "clear", phase: "moving", outcome: "pending" };
const last = { interaction: 1, object: "metal2", outcome: "delivered", questions: 0, seconds: 7.1 };
const idle = { ...GOLDEN.dialogue, interaction: 0, decision: "wait", belief: EVEN, last };
const asks = {
  ...idle,
  interaction: 2,
  decision: "ask",
  question: { type: "attr", attribute: "color", value: "white" },
  text: "Is it white?",
  prompt: 5,
  value: 30,
  alternatives: [pick("metal2", -20), pick("clear", -25)],
  expected_questions: 1,
};
const picks = {
  ...idle,
  interaction: 2,
  decision: "pick",
  belief: SURE,
  text: `I will get the ${NEW}.`,
  prompt: 6,
  value: 50,
  alternatives: [{ action: { type: "wait" }, value: 20 }],
};
const turn = (state) => ({ who: "nobody", state, since_ms: 1, onset_ms: null });

/** Sections in which nothing is the matter. */
const CALM = {
  ...GOLDEN,
  world: { ...GOLDEN.world, objects: NAMES.map((_, n) => [0.6, n / 5 - 0.5, 0, 0, 0, 0, 1]) },
  group: group({}),
  motion: { unconfirmed: null },
  control: { operator: ME, name: "", viewers: 1, asked_by: null, expires_ms: null },
  dialogue: idle,
  arm: rests,
  turn: turn("idle"),
};
const moving = { dialogue: picks, arm: { ...moves, moving: true, remaining_s: 3 } };

/** Sections of each state. */
export const STATES = {
  idle: CALM,
  asking: { ...CALM, dialogue: asks, turn: turn("asked") },
  // Before the arm has taken the order, its own section is of the dialogue before.
  decided: { ...CALM, dialogue: picks, turn: turn("moving") },
  fetching: { ...CALM, ...moving, turn: turn("moving") },
  stopped: { ...CALM, ...moving, arm: { ...moves, stopped: true }, turn: turn("stopped") },
  "stopped at a question": {
    ...CALM,
    dialogue: asks,
    arm: { ...rests, stopped: true },
    turn: turn("stopped"),
  },
  held: { ...CALM, ...moving, group: group({ policy: "held" }), turn: turn("down") },
  disconnected: { ...CALM, ...moving, turn: turn("moving") },
  delivered: {
    ...CALM,
    dialogue: {
      ...idle,
      text: `Here is the ${NEW}.`,
      last: { ...last, interaction: 2, object: "clear" },
      refusable: { interaction: 2, object: "clear", until_ms: 1e9 },
    },
    arm: { ...moves, phase: "done", outcome: "delivered" },
  },
};
