// @ts-check
import { s } from "../dom.js";
import { icon } from "../icons.js";
import { VIEWS } from "./cameras.js";

/**
 * Makes the elements.
 * @param {HTMLElement} element
 * @param {(key: string, args?: object) => string} t
 */
export function build(element, t) {
  loadStyle();
  const canvas = /** @type {HTMLCanvasElement} */ (make("canvas", "arm-canvas"));
  canvas.setAttribute("role", "img");
  const labels = make("ul", "arm-labels");
  labels.setAttribute("aria-label", t("arm.objects"));
  const notice = make("p", "arm-notice", t("arm.loading"));
  const badge = make("p", "arm-badge", t("arm.badge"));
  badge.hidden = true;
  const simulated = make("p", "arm-simulated", t("arm.simulated"));
  simulated.hidden = true;
  const caption = make("p", "arm-caption");
  caption.id = "arm-caption";
  const leaders = s("svg", { class: "arm-leaders", "aria-hidden": "true" });
  const stage = make("div", "arm-stage", canvas, leaders, labels, badge, simulated, notice);
  stage.tabIndex = 0;
  stage.setAttribute("role", "group");
  stage.setAttribute("aria-label", t("arm.stage"));
  stage.setAttribute("aria-describedby", caption.id);
  const buttons = VIEWS.map((name) => tool(name, t(`arm.view.${name}`)));
  if (document.fullscreenEnabled) {
    const wide = tool("wide", t("arm.wide"));
    wide.addEventListener("click", () => toggleFullScreen(stage));
    buttons.push(wide);
  }
  const tools = make("div", "arm-tools", ...buttons);
  tools.setAttribute("role", "group");
  tools.setAttribute("aria-label", t("arm.views"));
  stage.append(tools);
  element.replaceChildren(stage, caption);
  element.classList.add("arm-view");
  element.dataset.state = "loading";
  const notices = [badge, simulated, tools];
  return { canvas, labels, leaders, notice, notices, badge, simulated, caption, stage, buttons };
}

/**
 * @param {string} tag
 * @param {string} name of its class
 * @param {(Node|string)[]} children
 */
function make(tag, name, ...children) {
  const node = document.createElement(tag);
  node.className = name;
  node.append(...children);
  return node;
}

function loadStyle() {
  const style = document.createElement("link");
  Object.assign(style, {
    rel: "stylesheet",
    href: new URL("../../css/arm.css", import.meta.url).href,
  });
  document.head.append(style);
}

const ICONS = { start: "again", person: "eye", above: "above", wide: "wide" };

/** @param {string} name @param {string} label */
function tool(name, label) {
  const button = document.createElement("button");
  Object.assign(button, { type: "button", className: "arm-button", title: label });
  button.setAttribute("aria-label", label);
  button.dataset.view = name;
  button.append(icon(/** @type {any} */ (ICONS[name]), 18));
  return button;
}

/** @param {HTMLElement} stage */
function toggleFullScreen(stage) {
  const change = document.fullscreenElement ? document.exitFullscreen() : stage.requestFullscreen();
  // A browser may refuse; the picture stays as it is.
  change.catch(() => {});
}
