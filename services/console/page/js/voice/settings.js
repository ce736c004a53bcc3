// @ts-check
import { h } from "../dom.js";
import { icon } from "../icons.js";

/**
 * The dialog in which a person chooses who recognises, and what the browser does with the sound.
 * @param {{t: any, hasBrowser: boolean, choose: (change: object) => void,
 *   choices: import("./choices.js").Choices}} context
 * @returns {HTMLDialogElement}
 */
export function settingsDialog({ t, hasBrowser, choose, choices }) {
  const choice = (input, name, more) => {
    const words = h("span", {}, h("span", { text: t(name) }), h("small", { text: t(more) }));
    return h("label", { class: "voice-choice" }, input, words);
  };
  const box = (name) => {
    const onchange = (event) => choose({ [name]: event.target.checked });
    const input = h("input", { type: "checkbox", checked: choices[name], onchange });
    return choice(input, `voice.set.${name}`, `voice.set.${name}.more`);
  };
  const engine = (name, disabled) => {
    const onchange = () => choose({ engine: name });
    const checked = choices.engine === name;
    const properties = { type: "radio", name: "voice-engine", value: name, checked, disabled };
    const more = disabled ? "voice.engine.none" : `voice.engine.${name}.more`;
    return choice(h("input", { ...properties, onchange }), `voice.engine.${name}`, more);
  };
  const group = (name, ...children) =>
    h("fieldset", {}, h("legend", { text: t(name) }), ...children);
  const close = { type: "button", class: "tool", "aria-label": t("voice.settings.close") };
  const head = h(
    "div",
    { class: "help-head" },
    h("h2", { id: "voice-settings-title", text: t("voice.settings") }),
    h("button", { ...close, onclick: () => dialog.close() }, icon("close", 22)),
  );
  const boxes = ["headset", "echoCancellation", "noiseSuppression", "autoGainControl"].map(box);
  const dialog = h(
    "dialog",
    { class: "help voice-settings", "aria-labelledby": "voice-settings-title" },
    head,
    group("voice.engine", engine("robot", false), engine("browser", !hasBrowser)),
    group("voice.microphone", ...boxes),
  );
  return dialog;
}
