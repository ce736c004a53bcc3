// @ts-check

import { keptLanguage, tabStorage } from "./kept.js";
import { sessionId } from "./link/session.js";
import { connect } from "./link.js";
import { keep, Store } from "./store.js";
import { chooseLanguage, loadStrings, t, translate } from "./strings.js";
import { mountActions } from "./views/actions.js";
import { mountAlarm } from "./views/alarm.js";
import { mountCards } from "./views/cards.js";
import { mountControl } from "./views/control.js";
import { mountHealth } from "./views/health.js";
import { mountPart } from "./views/part.js";
import { mountQuestion } from "./views/question.js";
import { mountSay } from "./views/say.js";
import { mountTabs } from "./views/tabs.js";
import { mountTools } from "./views/tools.js";
import { mountTranscript } from "./views/transcript.js";
import { mountTurn } from "./views/turn.js";
import { mountWhy } from "./views/why.js";

/** @param {string} id @returns {HTMLElement} */
const at = (id) => /** @type {HTMLElement} */ (document.getElementById(id));

const store = new Store();
const link = connect({
  session: sessionId(tabStorage()),
  role: wishedRole(location.search),
  lastLine: () => store.lastLine,
});
keep(store, link);

await loadStrings(chooseLanguage(location.search, keptLanguage(), navigator.languages));
translate(document);

const context = { link, store, t };
mountActions(at("actions"), context);
mountAlarm(at("alarm"), at("polite"), context);
mountTurn(at("turn"), context);
mountQuestion(at("question"), context);
mountWhy(at("why"), context);
mountCards(at("cards"), context);
mountTranscript(at("transcript"), context);
mountSay(at("say"), context);
mountControl(at("control"), context);
mountTools(at("tools"), context);
mountTabs(at("tabs"), at("page"), context);
mountHealth(at("health"), context);
store.subscribe("welcome", ({ group }) => {
  at("group").textContent = group;
  document.title = `whichone · ${group}`;
});
document.documentElement.dataset.ready = "";

mountPart(at("voice"), () => import("./voice/index.js"), "mountVoice", context);
afterPaint(() => mountPart(at("arm"), () => import("./arm/index.js"), "mountArm", context));

/** What is heavy waits until the page has been seen. */
function afterPaint(f) {
  const idle = globalThis.requestIdleCallback ?? ((g) => setTimeout(g, 200));
  requestAnimationFrame(() => setTimeout(() => idle(f, { timeout: 1_000 }), 0));
}

/** @param {string} search */
function wishedRole(search) {
  const role = new URLSearchParams(search).get("role");
  return role === "viewer" || role === "screen" ? role : "operator";
}
