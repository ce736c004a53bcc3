// @ts-check
import { h } from "../dom.js";
import { icon } from "../icons.js";
import { desired } from "./desired.js";
import { outcomeKey, paragraphs } from "./model.js";
import { questionnaire } from "./questionnaire.js";

/**
 * @typedef {object} Shown
 * @property {any} person the participant, if any
 * @property {any} study the section
 * @property {any} scene
 * @property {(key: string, args?: object) => string} t
 * @property {(verb: string, args?: object) => Promise<any>} ask does a verb of the study's
 * @property {() => void} renew makes the page ready for the next participant
 */

/** @type {Record<string, (shown: Shown) => (HTMLElement|SVGElement)[]>} */
const SCREENS = {
  loading: ({ t }) => [lead(t("study.loading"))],
  off: ({ t }) => [heading(t("study.off")), lead(t("study.off.more"))],
  busy: ({ t, ask }) => [
    heading(t("study.busy")),
    lead(t("study.busy.more")),
    resume(t, ask, t("study.resume")),
  ],
  welcome: ({ t, study, ask }) => [
    heading(study.title ?? ""),
    lead(t("study.welcome")),
    go(t("study.begin"), () => ask("begin")),
  ],
  consent,
  instructions: ({ t, person, ask }) => [
    heading(t("study.instructions")),
    h("ol", { class: "study-steps" }, ...person.instructions.map(step)),
    go(t("study.continue"), () => ask("next")),
  ],
  drawn,
  over,
  questionnaire: ({ t, person, ask }) => [
    heading(t("study.questionnaire")),
    questionnaire(person.questionnaire, t, (answers) => ask("answer", { answers })),
  ],
  thanks: (shown) => ended(shown, "thanks"),
  left: (shown) => ended(shown, "left"),
  withdrawn: (shown) => ended(shown, shown.person.deleted ? "deleted" : "withdrawn"),
};

/**
 * Redraws a screen.
 * @param {HTMLElement} element
 * @param {string} screen
 * @param {Shown} shown
 */
export function drawScreen(element, screen, shown) {
  element.replaceChildren(...(SCREENS[screen]?.(shown) ?? []));
}

function consent({ t, person, ask }) {
  const agree = h("input", { type: "checkbox", id: "agree" });
  const next = go(t("study.continue"), () => ask("consent"));
  next.disabled = true;
  agree.addEventListener("change", () => {
    next.disabled = !agree.checked;
  });
  const text = paragraphs(person.consent).map((part) => h("p", { text: part }));
  return [
    heading(t("study.consent")),
    h("div", { class: "study-text" }, ...text),
    h(
      "label",
      { class: "study-agree", for: "agree" },
      agree,
      h("span", { text: t("study.agree") }),
    ),
    next,
  ];
}

function drawn({ t, person, scene, ask }) {
  const { trial } = person;
  const start = go(t("study.start"), () => ask("start"));
  start.disabled = trial.waits_for !== null;
  start.id = "start";
  const waits = trial.waits_for ? t(`study.waits.${trial.waits_for}`) : t("study.ready");
  const number = trial.practice ? t("study.practice.more") : t("study.task");
  return [
    heading(t("study.desired")),
    lead(number),
    desired(scene, trial.desired, t),
    start,
    h("p", { class: "study-note", role: "status", text: waits }),
  ];
}

function over({ t, person, scene, ask }) {
  const { trial } = person;
  const brought = trial.picked && ["right", "wrong"].includes(trial.outcome);
  const right = trial.outcome === "right";
  const mark = h(
    "div",
    { class: "study-mark", "data-right": right ? "yes" : "no" },
    icon(right ? "check" : "undo", 44),
  );
  const more = `${outcomeKey(trial)}.more`;
  return [
    mark,
    heading(t(outcomeKey(trial))),
    t(more) === more ? lead("") : lead(t(more)),
    brought ? desired(scene, trial.picked, t) : lead(""),
    go(t(person.next ? "study.next" : "study.continue"), () => ask("next")),
  ];
}

function ended({ t, person, renew }, key) {
  return [
    heading(t(`study.${key}`)),
    lead(t(`study.${key}.more`)),
    h(
      "p",
      { class: "study-code" },
      t("study.code"),
      " ",
      h("strong", { text: person.participant }),
    ),
    h("button", { type: "button", class: "study-again", onclick: renew, text: t("study.again") }),
  ];
}

function resume(t, ask, words) {
  const input = h("input", {
    type: "text",
    id: "code",
    autocomplete: "off",
    autocapitalize: "characters",
    maxlength: 6,
    spellcheck: "false",
  });
  const form = h(
    "form",
    { class: "study-resume" },
    h("label", { for: "code", text: words }),
    input,
    h("button", { type: "submit", text: t("study.go_on") }),
  );
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    if (input.value.trim()) ask("resume", { participant: input.value.trim() });
  });
  return form;
}

const heading = (text) => h("h2", { class: "study-heading", tabindex: -1, text });
const lead = (text) => h("p", { class: "study-lead", text });
const step = (text) => h("li", {}, h("span", { text }));

function go(text, press) {
  const button = h("button", { type: "button", class: "study-go", text });
  button.addEventListener("click", press);
  return button;
}
