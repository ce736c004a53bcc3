// @ts-check
import { h } from "../dom.js";

/**
 * The settings of the voice: whether the robot is heard here, who recognises, and what the browser does
 * with the sound.
 * @param {{t: any, hasBrowser: boolean, choose: (change: object) => void, toggleSound: () => void,
 *   choices: import("./choices.js").Choices}} context
 * @returns {{nodes: HTMLElement[], sound: HTMLInputElement}}
 */
export function voiceSettings({ t, hasBrowser, choose, toggleSound, choices }) {
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
    h("div", { role: "group", "aria-label": t(name), class: "voice-group" }, ...children);
  const sound = h("input", { type: "checkbox", onchange: toggleSound });
  const boxes = ["headset", "echoCancellation", "noiseSuppression", "autoGainControl"].map(box);
  const nodes = [
    h("label", { class: "settings-box" }, sound, h("span", { text: t("voice.sound") })),
    h("p", { class: "voice-group-title", text: t("voice.engine") }),
    group("voice.engine", engine("robot", false), engine("browser", !hasBrowser)),
    h("p", { class: "voice-group-title", text: t("voice.microphone") }),
    group("voice.microphone", ...boxes),
  ];
  return { nodes, sound };
}
