// @ts-check
import { h } from "../dom.js";
import { keep, recall } from "../kept.js";
import { Feed } from "./feed.js";
import { watchSeen } from "./watch.js";

/** Content of the part: the drawn picture, the camera's, or both. */
const SOURCES = ["model", "camera", "both"];

/**
 * A camera's picture next to or instead of the drawn one, with a switch; nothing if the console has no
 * camera.
 * @param {HTMLElement} element the part; its `data-source` names the content
 * @param {HTMLElement} stage of the drawn picture
 * @param {{store: any, t: (key: string, args?: object) => string}} page
 */
export function mountCamera(element, stage, { store, t }) {
  let known = "";
  store.subscribe("welcome", ({ settings }) => {
    const camera = settings?.camera ?? null;
    if (JSON.stringify(camera) === known) return;
    known = JSON.stringify(camera);
    for (const part of element.querySelectorAll(".camera, .arm-source")) part.remove();
    delete element.dataset.source;
    if (camera) show(camera, element, stage, t);
  });
}

function show(camera, element, stage, t) {
  const image = h("img", { class: "camera-image", alt: t("camera.alt") });
  const notice = h("p", { class: "camera-notice", role: "status" });
  const figure = h("div", { class: "camera", "data-state": "waiting" }, image, notice);
  const feed = new Feed(image, camera, (state) => {
    figure.dataset.state = state;
    const { host } = new URL(camera.url);
    notice.textContent = state === "shown" ? "" : t(`camera.${state}`, { host });
  });
  stage.before(sources(element, t));
  stage.after(figure);
  watchSeen(figure, (isSeen) => {
    // Before its style is loaded, it is visible even if only the model was chosen.
    const isChosen = element.dataset.source !== SOURCES[0];
    if (isSeen && isChosen && figure.isConnected) feed.start();
    else feed.stop();
  });
}

function sources(element, t) {
  const kept = recall("source") ?? "";
  element.dataset.source = SOURCES.includes(kept) ? kept : SOURCES[0];
  const make = (value) => {
    const onchange = () => {
      element.dataset.source = value;
      keep("source", value === SOURCES[0] ? null : value);
    };
    const checked = element.dataset.source === value;
    const input = h("input", { type: "radio", name: "arm-source", value, checked, onchange });
    return h("label", {}, input, h("span", { text: t(`camera.source.${value}`) }));
  };
  const group = { class: "segments arm-source", role: "group", "aria-label": t("camera.source") };
  return h("div", group, ...SOURCES.map(make));
}
