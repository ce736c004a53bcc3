// @ts-check
import { eachFrame, h, setText } from "../dom.js";
import { keptLanguage, tabStorage } from "../kept.js";
import { sessionId } from "../link/session.js";
import { connect } from "../link.js";
import { Hold } from "../model/hold.js";
import { keepNow } from "../now.js";
import { addressOf } from "../place.js";
import { stopper } from "../stop.js";
import { keep, Store } from "../store.js";
import { chooseLanguage, loadStrings, t, translate } from "../strings.js";
import { mountActions } from "../views/actions.js";
import { mountAlarm } from "../views/alarm.js";
import { attempt } from "../views/attempt.js";
import { mountResume } from "../views/resume.js";
import { mountTools } from "../views/tools.js";
import { inControl } from "./control.js";
import { picturesOf } from "./numbers.js";
import { Secret } from "./secret.js";
import { reportView } from "./tables.js";

/** Between two looks at the results while nothing has changed, milliseconds. */
const LOOK_MS = 30_000;
const FILES = {
  "interactions.csv": "study.files.interactions",
  "participants.csv": "study.files.participants",
  "dictionary.csv": "study.files.dictionary",
  "export.json": "study.files.json",
};

/** @param {string} id @returns {HTMLElement} */
const at = (id) => /** @type {HTMLElement} */ (document.getElementById(id));

const store = new Store();
const session = sessionId(tabStorage());
const link = connect({ session, role: "viewer", lastLine: () => store.lastLine });
// Before everything else, so that a stop that waits is sent first.
const stop = stopper({ link, store });
keep(store, link);
await loadStrings(chooseLanguage(location.search, keptLanguage(), navigator.languages));
translate(document);

const context = { link, store, t, stop, hold: new Hold() };
keepNow(context);
const secret = new Secret(null);
mountActions(at("actions"), context);
mountResume(at("resume"), context);
mountAlarm(at("alarm"), at("polite"), context);
mountTools(at("tools"), context);
for (const [file, key] of Object.entries(FILES)) {
  at("files").append(
    h("li", {}, h("a", { href: addressOf(`/study/${file}`), download: file, text: t(key) })),
  );
}

let looked = "";
let version = 0;

/** Reads the results again where something has come to them. */
async function look(force = false) {
  const { participants, interactions, complete, withdrawn } = store.get("study") ?? {};
  const now = JSON.stringify([participants, interactions, complete, withdrawn]);
  if (now === looked && !force) return;
  looked = now;
  try {
    const answer = await fetch(addressOf("/study/report.json"));
    if (!answer.ok) throw new Error(await answer.text());
    show(await answer.json());
  } catch (error) {
    const why = /** @type {Error} */ (error).message;
    at("results").replaceChildren(
      h("p", { class: "results-warn", text: t("study.results.failed", { why }) }),
    );
  }
}

function show(report) {
  at("results").replaceChildren(...reportView(report, t));
  version += 1;
  const picture = (name) =>
    h("img", {
      src: addressOf(`/study/${name}.svg?v=${version}`),
      alt: t(`study.picture.${name}`),
    });
  at("pictures").replaceChildren(...picturesOf(report).map(picture));
  document.documentElement.dataset.ready = "";
}

const draw = eachFrame(() => {
  const study = store.get("study");
  const welcome = store.get("welcome");
  setText(at("title"), study?.title ?? "whichone");
  document.title = `${t("study.results")} · ${study?.title ?? "whichone"}`;
  at("now").replaceChildren(now(study, welcome));
  look();
});

function now(study, welcome) {
  if (welcome && !welcome.settings?.study) {
    return h("p", { class: "empty", text: `${t("study.off")}. ${t("study.off.more")}` });
  }
  const person = study?.active;
  const trouble = study?.trouble && h("p", { class: "results-warn", text: study.trouble });
  if (!person) {
    return h("div", {}, h("p", { class: "empty", text: t("study.now.nobody") }), trouble || null);
  }
  const { trial } = person;
  const facts = [["now.progress", `${person.done} / ${person.total}`]];
  if (trial) {
    facts.push(["now.desired", trial.desired], ["now.policy", trial.policy]);
    facts.push(["now.said", String(trial.said)]);
  }
  const pairs = facts.map(([key, text]) =>
    h("div", {}, h("dt", { text: t(`study.${key}`) }), h("dd", { text })),
  );
  const args = { page: secret.value, participant: person.participant };
  const ask = (verb) => () =>
    attempt(
      inControl(context, () => link.do(`study.${verb}`, args)),
      context,
    );
  const button = (verb) =>
    h("button", {
      type: "button",
      class: "small",
      text: t(`study.now.${verb}`),
      onclick: ask(verb),
    });
  const acts = [button("close"), person.stage === "running" ? button("spoilt") : null];
  return h(
    "div",
    { class: "results-now" },
    h("strong", { class: "code", text: person.participant }),
    h("span", { text: t(`study.stage.${person.stage}`) }),
    h("dl", {}, ...pairs),
    h("div", { class: "results-act" }, ...acts),
    trouble || null,
  );
}

store.subscribe(["study", "welcome"], draw);
draw();
setInterval(() => look(true), LOOK_MS);
