// @ts-check
import { icon } from "../icons.js";
import { VIEWS } from "./cameras.js";
import { Overlay } from "./overlay.js";
import { ArmView } from "./view.js";
import { armWords, thoughtsOf } from "./words.js";

/** How long the next try waits after the robot's description could not be had, milliseconds. */
const RETRY_MS = 2_000;

/**
 * Shows the arm in 3D.
 * @param {HTMLElement} element gets `armView`, which tests read
 * @param {{link: any, store: any, t: (key: string, args?: object) => string}} page
 */
export function mountArm(element, { link, store, t }) {
  const parts = build(element, t);
  const say = () => {
    const words = armWords(store.get("arm"), store.get("scene"), store.get("trajectory"), t);
    if (parts.caption.textContent === words) return;
    parts.caption.textContent = words;
    parts.canvas.setAttribute("aria-label", words);
  };
  store.subscribe(["arm", "scene", "trajectory"], say);
  store.subscribe("arm", (arm) => {
    element.dataset.stopped = String(Boolean(arm?.stopped));
    parts.badge.hidden = !arm?.stopped;
  });
  say();
  let view;
  try {
    view = new ArmView(parts.canvas, parts.stage, link, new Overlay(parts.labels, t));
  } catch {
    element.dataset.state = "words";
    for (const button of parts.buttons) button.hidden = true;
    parts.notice.textContent = t("arm.no_webgl");
    return;
  }
  Object.assign(element, { armView: view });
  follow(view, store, link);
  watch(view, parts, t);
  fetchRobot(view, element, parts, link, t);
}

/** Makes the elements. */
function build(element, t) {
  const make = (tag, name, ...children) => {
    const node = document.createElement(tag);
    node.className = name;
    node.append(...children);
    return node;
  };
  const style = document.createElement("link");
  Object.assign(style, {
    rel: "stylesheet",
    href: new URL("../../css/arm.css", import.meta.url).href,
  });
  document.head.append(style);
  const canvas = /** @type {HTMLCanvasElement} */ (make("canvas", "arm-canvas"));
  canvas.setAttribute("role", "img");
  const labels = make("ul", "arm-labels");
  labels.setAttribute("aria-label", t("arm.objects"));
  const notice = make("p", "arm-notice", t("arm.loading"));
  const badge = make("p", "arm-badge", t("arm.badge"));
  badge.hidden = true;
  const caption = make("p", "arm-caption");
  caption.id = "arm-caption";
  const stage = make("div", "arm-stage", canvas, labels, badge, notice);
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
  return { canvas, labels, notice, badge, caption, stage, buttons };
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

/** Has the view follow the server. */
function follow(view, store, link) {
  const think = () => view.setThoughts(thoughtsOf(store.get("dialogue"), store.get("scene")));
  store.subscribe("scene", (scene) => {
    view.setScene(scene);
    think();
  });
  store.subscribe("dialogue", think);
  store.subscribe("world", (world) => view.setWorld(world));
  store.subscribe("trajectory", (trajectory) => view.setTrajectory(trajectory));
  store.subscribe("arm", (arm) => {
    view.setArm(arm);
  });
  link.on("joints", (message) => view.setJoints(message));
}

/** Has the view follow the page: its size, its theme, whether it is seen. */
function watch(view, { stage, canvas, notice, buttons }, t) {
  new ResizeObserver(([{ contentRect }]) =>
    view.setSize(contentRect.width, contentRect.height),
  ).observe(stage);
  new IntersectionObserver(([{ isIntersecting }]) => view.setSeen(isIntersecting)).observe(stage);
  const theme = () => view.setTheme(isDark(stage));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", theme);
  new MutationObserver(theme).observe(document.documentElement, { attributes: true });
  theme();
  const calm = matchMedia("(prefers-reduced-motion: reduce)");
  for (const button of buttons.filter(({ dataset }) => VIEWS.includes(dataset.view ?? ""))) {
    button.addEventListener("click", () => view.look(button.dataset.view, calm.matches));
  }
  canvas.addEventListener("webglcontextlost", () => {
    notice.hidden = false;
    notice.textContent = t("arm.lost");
  });
  canvas.addEventListener("webglcontextrestored", () => {
    notice.hidden = true;
  });
}

/** Whether text on the element is light: then the page is dark, whoever decided it. */
function isDark(element) {
  const [r, g, b] = (getComputedStyle(element).color.match(/[\d.]+/g) ?? ["0", "0", "0"]).map(
    Number,
  );
  return 0.3 * r + 0.6 * g + 0.1 * b > (Math.max(r, g, b) <= 1 ? 0.5 : 128);
}

/** Gets the robot's description, and again whenever the connection has come back. */
function fetchRobot(view, element, { notice }, link, t) {
  let known = "";
  let retry = 0;
  const load = async () => {
    clearTimeout(retry);
    try {
      const answer = await fetch("/robot.urdf");
      if (!answer.ok) throw new Error(`${answer.status}`);
      const description = await answer.text();
      if (description === known) return;
      view.setRobot(description);
      known = description;
      element.dataset.state = "ready";
      notice.hidden = true;
    } catch (error) {
      notice.hidden = known !== "";
      notice.textContent = t("arm.no_robot", {
        why: error instanceof Error ? error.message : String(error),
      });
      retry = setTimeout(load, RETRY_MS);
    }
  };
  let wasUp = true;
  link.on("status", ({ state }) => {
    if (state === "up" && !wasUp) load();
    wasUp = state === "up";
  });
  load();
}
