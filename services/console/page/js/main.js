// @ts-check

import { keepDelivery } from "./delivery.js";
import { linked } from "./history/address.js";
import { keptLanguage, tabStorage } from "./kept.js";
import { sessionId } from "./link/session.js";
import { connect } from "./link.js";
import { Hold } from "./model/hold.js";
import { keepNow } from "./now.js";
import { whoSpeaks } from "./settings/person.js";
import { stopper } from "./stop.js";
import { keep, Store } from "./store.js";
import { chooseLanguage, loadStrings, t, translate } from "./strings.js";
import { mountActions } from "./views/actions.js";
import { mountAlarm } from "./views/alarm.js";
import { notify } from "./views/attempt.js";
import { mountCards } from "./views/cards.js";
import { mountControl } from "./views/control.js";
import { mountHealth } from "./views/health.js";
import { mountPart } from "./views/part.js";
import { mountQuestion } from "./views/question.js";
import { mountResume } from "./views/resume.js";
import { mountSay } from "./views/say.js";
import { mountStrip } from "./views/strip.js";
import { mountTabs } from "./views/tabs.js";
import { mountTools, toolButton } from "./views/tools.js";
import { mountTranscript } from "./views/transcript.js";
import { mountTurn } from "./views/turn.js";
import { mountWhy } from "./views/why.js";

/** Longest wait for the console's language before the page's texts are rendered, milliseconds. */
const WELCOME_MS = 400;

/** @param {string} id @returns {HTMLElement} */
const at = (id) => /** @type {HTMLElement} */ (document.getElementById(id));

const store = new Store();
const role = wishedRole(location.search);
document.documentElement.dataset.role = role;
const session = sessionId(tabStorage());
const link = connect({
  session,
  role,
  name: whoSpeaks,
  lastLine: () => store.resumeAfter,
});
// Before everything else, so that a stop that waits is sent first.
const stop = stopper({ link, store });
keep(store, link);
keepDelivery({ link, store });

const wished = [await setLanguage(), ...navigator.languages];
await loadStrings(chooseLanguage(location.search, keptLanguage(), wished));
translate(document);

const context = { link, store, t, session, stop, hold: new Hold() };
keepNow(context);
mountActions(at("actions"), context);
mountResume(at("resume"), context);
mountAlarm(at("alarm"), at("polite"), context);
mountTurn(at("turn"), context);
mountQuestion(at("question"), context);
mountStrip(at("strip"), context);
mountWhy(at("why"), context);
mountCards(at("cards"), context);
mountTranscript(at("transcript"), context);
mountSay(at("say"), context);
mountControl(at("control"), context);
mountTools(at("tools"), context);
at("tools").prepend(
  toolButton("scene", t("scene.show"), "scene", () => openScene()),
  toolButton("history", t("history.show"), "history", () => openHistory()),
);
mountTabs(at("tabs"), at("page"), context);
mountHealth(at("health"), context);
store.subscribe("welcome", ({ group }) => {
  at("group").textContent = group;
  document.title = `whichone · ${group}`;
});
document.documentElement.dataset.ready = "";

mountPart(at("voice"), () => import("./voice/index.js"), "mountVoice", context);
afterPaint(() => mountPart(at("arm"), () => import("./arm/index.js"), "mountArm", context));

/** Runs `f` once the page has been painted and is idle: for heavy parts. */
function afterPaint(f) {
  const idle = globalThis.requestIdleCallback ?? ((g) => setTimeout(g, 200));
  requestAnimationFrame(() => setTimeout(() => idle(f, { timeout: 1_000 }), 0));
}

/** @type {Promise<(interaction?: number) => void>|null} */
let history = null;
afterPaint(openLinked);
addEventListener("hashchange", () => history ?? openLinked());

/** Opens the interaction that the address names: `#history=12`. */
function openLinked() {
  const interaction = linked(location.hash);
  if (interaction !== null) openHistory(interaction);
}

/** Opens the history, which is loaded when it is wanted first. @param {number} [interaction] */
async function openHistory(interaction) {
  try {
    history ??= import("./history/index.js").then((part) => part.mountHistory(context));
    (await history)(interaction);
  } catch {
    history = null;
    notify(t("history.unavailable"));
  }
}

/** @type {Promise<() => void>|null} */
let scene = null;

/** Opens the scene editor, which is loaded when it is wanted first. */
async function openScene() {
  try {
    scene ??= import("./scene/index.js").then((part) => part.mountScene(context));
    (await scene)();
  } catch {
    scene = null;
    notify(t("scene.unavailable"));
  }
}

/** The language that the console is set to, if it says so soon enough. */
function setLanguage() {
  return new Promise((resolve) => {
    setTimeout(() => resolve(""), WELCOME_MS);
    link.on("welcome", ({ settings }) => resolve(settings?.language ?? ""));
  });
}

/** @param {string} search */
function wishedRole(search) {
  const role = new URLSearchParams(search).get("role");
  return role === "viewer" || role === "screen" ? role : "operator";
}
