// @ts-check
import { h, setAttribute, setText } from "../dom.js";
import { icon } from "../icons.js";
import { microphone } from "./icon.js";
import { voiceSettings } from "./settings.js";
import { meterShare } from "./sound.js";

/**
 * The elements of the voice part.
 * @param {HTMLElement} element
 * @param {{t: any, hasBrowser: boolean, toggle: (what: string) => void,
 *   choose: (change: object) => void, choices: import("./choices.js").Choices, settings: any}} context
 */
export function build(element, { t, hasBrowser, toggle, choose, choices, settings }) {
  const words = h("span", { class: "voice-words" });
  const more = h("span", { class: "voice-more" });
  const meter = h("span", { class: "voice-meter", "aria-hidden": "true" }, h("span", {}));
  const text = h("span", { class: "voice-text" }, words, more);
  const lamp = h("span", { class: "voice-lamp" }, microphone(26));
  const talk = h(
    "button",
    { type: "button", class: "voice-talk", "aria-keyshortcuts": "Space" },
    lamp,
    text,
    meter,
  );
  const handsFree = switchButton("ear", t("voice.handsfree"), () => toggle("handsFree"));
  const sound = switchButton("speak", t("voice.sound"), () => toggle("sound"));
  const unlock = h(
    "button",
    { type: "button", class: "voice-unlock", hidden: true, onclick: () => toggle("unlock") },
    icon("speak"),
    t("voice.unlock"),
  );
  const off = h("button", {
    type: "button",
    class: "small",
    text: t("voice.open.close"),
    onclick: () => toggle("close"),
  });
  const open = h("p", { class: "voice-open", hidden: true }, h("span", { text: t("voice.open") }));
  open.append(off);
  const note = h("p", { class: "voice-note", role: "status" });
  const fault = h("p", { class: "voice-fault", role: "alert" });
  const toggleSound = () => toggle("sound");
  const { nodes, sound: heard } = voiceSettings({ t, hasBrowser, choose, toggleSound, choices });
  settings.add(t("settings.voice"), ...nodes);
  const row = h("div", { class: "voice-row" }, talk, handsFree, sound);
  element.replaceChildren(row, unlock, fault, note, open);
  return { talk, words, more, meter, handsFree, sound, heard, unlock, open, note, fault };
}

/**
 * Shows the present settings.
 * @param {ReturnType<typeof build>} view
 * @param {object} now
 * @param {ReturnType<typeof import("./sign.js").sign>} now.sign
 * @param {any} now.talk a `Talk`
 * @param {any} now.playback a `Playback`
 * @param {any} now.t
 */
export function show(view, { sign, talk, playback, t }) {
  setText(view.words, t(`voice.talk.${sign.key}`));
  const more = t.has(`voice.talk.${sign.key}.more`) ? t(`voice.talk.${sign.key}.more`) : "";
  setText(view.more, more);
  setAttribute(view.talk, "data-state", sign.state);
  setAttribute(view.talk, "aria-pressed", String(talk.talks));
  view.talk.disabled = sign.disabled;
  setAttribute(view.handsFree, "aria-pressed", String(talk.handsFree));
  setAttribute(view.sound, "aria-pressed", String(!playback.muted));
  setAttribute(view.sound, "data-sounding", playback.sounds);
  view.heard.checked = !playback.muted;
  view.meter.style.setProperty("--level", meterShare(talk.levelDb).toFixed(2));
  view.unlock.hidden = !playback.locked;
  view.open.hidden = !talk.isOpen || talk.talks || talk.handsFree;
  const note = talk.slow ? { key: "voice.note.slow" } : talk.note;
  setText(view.note, note ? t(note.key, note.args) : "");
  setText(view.fault, talk.fault ? t(talk.fault.key, talk.fault.args) : "");
}

function switchButton(name, label, onclick) {
  const properties = { type: "button", class: "voice-switch", "aria-label": label, title: label };
  return h("button", { ...properties, onclick }, icon(name, 22));
}
