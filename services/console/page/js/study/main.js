// @ts-check
import { eachFrame, setAttribute, setText } from "../dom.js";
import { keptLanguage, tabStorage } from "../kept.js";
import { sessionId } from "../link/session.js";
import { connect } from "../link.js";
import { whoControls } from "../model/turn.js";
import { keepNow } from "../now.js";
import { openSheet } from "../sheet.js";
import { stopper } from "../stop.js";
import { keep, Store } from "../store.js";
import { chooseLanguage, loadStrings, t, translate } from "../strings.js";
import { mountActions } from "../views/actions.js";
import { mountAlarm } from "../views/alarm.js";
import { attempt } from "../views/attempt.js";
import { mountPart } from "../views/part.js";
import { mountSay } from "../views/say.js";
import { mountTools } from "../views/tools.js";
import { mountTurn } from "../views/turn.js";
import { desired } from "./desired.js";
import { lastHeard, participantOf, progressOf, robotWords, screenOf } from "./model.js";
import { drawScreen } from "./screens.js";
import { Secret } from "./secret.js";
import { withdrawDialog } from "./withdraw.js";

/** Delay before control is requested again, milliseconds. */
const ASK_MS = 5_000;
/** … and who this page is about, where that was not to be found out. */
const FIND_MS = 500;

/** @param {string} id @returns {HTMLElement} */
const at = (id) => /** @type {HTMLElement} */ (document.getElementById(id));

const store = new Store();
const secret = new Secret(tabStorage());
const link = connect({
  session: sessionId(tabStorage()),
  role: "operator",
  lastLine: () => store.lastLine,
});
// Before everything else, so that a stop that waits is sent first.
const stop = stopper({ link, store });
keep(store, link);
await loadStrings(chooseLanguage(location.search, keptLanguage(), navigator.languages));
translate(document);

const context = { link, store, t, stop };
keepNow(context);
mountActions(at("actions"), context);
mountAlarm(at("alarm"), at("polite"), { ...context, isParticipant: true });
mountTurn(at("turn"), context);
mountSay(at("say"), context);
mountTools(at("tools"), context);

/** The participant's code, once there is one. @type {string|null} */
let me = null;
let known = false;
let drawn = "";
let askedAt = Number.NEGATIVE_INFINITY;
let hasVoice = false;
const dialog = withdrawDialog(t, (deletes) => ask("withdraw", { delete: deletes }));
at("withdraw").addEventListener("click", () => openSheet(dialog, store));

/** Does a verb of the study's; reports a failure. */
async function ask(verb, args = {}) {
  const done = await attempt(link.do(`study.${verb}`, { page: secret.value, ...args }), context);
  if (done?.participant) me = done.participant;
  draw();
  return done;
}

/** The device is handed to the next participant. */
function renew() {
  secret.renew();
  me = null;
  draw();
}

/** Resumes the session that this page had before it was reloaded. */
async function find() {
  const welcome = store.get("welcome");
  if (!welcome) return;
  if (welcome.settings?.study) {
    const found = await link.do("study.find", { page: secret.value }).catch(() => null);
    // Retries after any failure.
    if (found === null) return void setTimeout(find, FIND_MS);
    me = found.participant ?? me;
  }
  known = true;
  draw();
}

/** The participant's page speaks for the robot's operator. */
function takeControl(screen) {
  const who = whoControls(store.get("control"), store.get("welcome"));
  const wants = screen === "drawn" || screen === "running";
  const now = performance.now();
  if (!wants || who === "mine" || who === "unknown" || now - askedAt < ASK_MS) return;
  askedAt = now;
  link.do("take_control").catch(() => {});
}

const draw = eachFrame(() => {
  const study = store.get("study");
  const welcome = store.get("welcome");
  const scene = store.get("scene");
  const person = participantOf(me, study);
  const screen = known ? screenOf({ me, study, welcome }) : "loading";
  document.body.dataset.screen = screen;
  setText(at("title"), person?.title ?? study?.title ?? "whichone");
  document.title = at("title").textContent ?? "";
  const progress = progressOf(person);
  setText(at("progress"), progress ? t(...progress) : "");
  at("withdraw").hidden = !person || ["thanks", "withdrawn", "left"].includes(screen);
  at("running").hidden = screen !== "running";
  at("screen").hidden = screen === "running";
  if (screen === "running") drawRunning(person, scene);
  const shown = { person, study, scene, t, ask, renew };
  const next = JSON.stringify([screen, person?.trial, me, scene?.key, study?.title]);
  if (screen !== "running" && next !== drawn) {
    const moved = at("screen").dataset.screen !== screen;
    const focused = document.activeElement?.id;
    drawScreen(at("screen"), screen, shown);
    if (!moved && focused) document.getElementById(focused)?.focus({ preventScroll: true });
    at("screen").dataset.screen = screen;
    if (moved && drawn !== "") focusOn(".study-heading");
  }
  if (screen === "running" && at("screen").dataset.screen !== "running") {
    at("screen").dataset.screen = "running";
    at("stage").focus({ preventScroll: true });
    scrollTo(0, 0);
  }
  drawn = next;
  takeControl(screen);
});

function drawRunning(person, scene) {
  if (!hasVoice) {
    hasVoice = true;
    mountPart(at("voice"), () => import("../voice/index.js"), "mountVoice", context);
  }
  const key = `${scene?.key} ${person.trial.desired}`;
  if (at("aim").dataset.key !== key) {
    at("aim").replaceChildren(desired(scene, person.trial.desired, t));
    at("aim").dataset.key = key;
  }
  if (person.show_belief && at("belief").hidden) {
    at("belief").hidden = false;
    // A participant asks in words of their own.
    const readOnly = { ...context, readOnly: true };
    mountPart(at("cards"), () => import("../views/cards.js"), "mountCards", readOnly);
  }
  setAttribute(at("running"), "data-belief", person.show_belief);
  setText(at("words"), robotWords(store.get("dialogue"), person.trial) || t("study.speak"));
  const heard = lastHeard(store.get("lines"), person.trial.started_at);
  const said = heard ? t(heard.meant ? "study.heard" : "study.unmeant", { text: heard.text }) : "";
  setText(at("heard"), said);
}

function focusOn(selector) {
  const node = document.querySelector(selector);
  if (node instanceof HTMLElement) node.focus({ preventScroll: true });
  scrollTo(0, 0);
}

// The space bar talks to the robot only while there is something to say to it.
addEventListener(
  "keydown",
  (event) => {
    if (event.code !== "Space" || event.target === document.getElementById("stop")) return;
    if (document.body.dataset.screen !== "running") {
      event.stopPropagation();
    }
  },
  { capture: true },
);
store.subscribe("welcome", find);
store.subscribe(["study", "scene", "dialogue", "lines", "control", "link"], draw);
setInterval(draw, ASK_MS);
document.documentElement.dataset.ready = "";
