// @ts-check
import { calm } from "../dom.js";
import { pressObject } from "../views/press.js";
import { mountCamera } from "./camera.js";
import { VIEWS } from "./cameras.js";
import { followDescription } from "./description.js";
import { forwardInput } from "./input.js";
import { Overlay } from "./overlay.js";
import { build } from "./parts.js";
import { openPicture } from "./picture.js";
import { watchPointing } from "./pointing.js";
import { watchSeen, watchSize, watchTheme } from "./watch.js";
import { armWords, thoughtsOf } from "./words.js";

/** Queries for tests: methods of `Questions`. */
const QUESTIONS = ["stats", "clearStats", "shown", "forward", "spin", "lose", "restore"];

/**
 * Shows the arm in 3D. The page has the elements, what a person does to them, and the connection;
 * the picture itself is drawn elsewhere (see `openPicture`).
 * @param {HTMLElement} element gets `armView`, which tests ask
 * @param {{link: any, store: any, t: any}} page
 */
export async function mountArm(element, { link, store, t }) {
  const parts = build(element, t);
  sayInWords(element, parts, store, t);
  mountCamera(element, parts.stage, { store, t });
  const overlay = new Overlay(parts, t);
  const picture = await openPicture(parts, hearing(element, parts, overlay, t));
  if (!picture) {
    element.dataset.state = "words";
    for (const button of parts.buttons) button.hidden = true;
    parts.notice.textContent = t("arm.no_webgl");
    return;
  }
  const asks = QUESTIONS.map((what) => [what, (...args) => picture.ask(what, ...args)]);
  Object.assign(element, { armView: Object.fromEntries(asks) });
  watch(picture, parts, overlay);
  follow(picture, overlay, store, link);
  letChoose(overlay, parts.canvas, { link, store, t });
  drawRobot(picture, element, parts, link, t);
}

/** The arm's state, in words and as an icon. */
function sayInWords(element, parts, store, t) {
  const say = () => {
    const [now, arm, scene, way] = ["now", "arm", "scene", "trajectory"].map((n) => store.get(n));
    const words = armWords(now, arm, scene, way, t);
    if (parts.caption.textContent === words) return;
    parts.caption.textContent = words;
    parts.canvas.setAttribute("aria-label", words);
  };
  store.subscribe(["now", "arm", "scene", "trajectory"], say);
  store.subscribe("now", ({ is }) => {
    element.dataset.stopped = String(is === "stopped");
    parts.badge.hidden = is !== "stopped";
  });
  store.subscribe("welcome", ({ settings }) => {
    parts.simulated.hidden = !settings?.simulated;
  });
}

/** Handlers of the picture's notifications. */
function hearing(element, { notice }, overlay, t) {
  return ({ picture, lost }) => {
    if (lost) {
      element.dataset.picture = "lost";
      notice.hidden = false;
      notice.textContent = t("arm.lost");
      return;
    }
    overlay.place(picture.boxes, picture.held);
    if (!picture.robot) return;
    element.dataset.picture = picture.fine ? "fine" : "coarse";
    notice.hidden = true;
  };
}

/** The scene with the objects alone that the world shows, in its order. */
function standingOf(scene) {
  return scene && { ...scene, objects: scene.standing ?? scene.objects };
}

/** Has the picture follow the server. */
function follow(picture, overlay, store, link) {
  let key = null;
  const think = () => {
    const { question } = store.get("now");
    const thoughts = thoughtsOf(store.get("belief"), question, standingOf(store.get("scene")));
    overlay.setThoughts(thoughts);
    picture.call("setThoughts", thoughts);
  };
  store.subscribe("scene", (scene) => {
    if (scene && scene.key !== key) {
      key = scene.key;
      overlay.setScene(standingOf(scene));
      picture.call("setScene", standingOf(scene));
    }
    think();
  });
  store.subscribe(["belief", "now"], think);
  store.subscribe("world", (world) => picture.call("setWorld", world));
  store.subscribe("trajectory", (trajectory) => picture.call("setTrajectory", trajectory));
  store.subscribe("arm", (arm) => picture.call("setArm", arm));
  link.on("joints", (message) => {
    // Threads count from instants of their own, which the browser converts to one clock.
    const clockMs = link.toServer(0) - performance.timeOrigin;
    picture.call("setJoints", message, link.serverNow(), clockMs);
  });
}

/** Names the object under the pointer; the operator chooses an object by a click, as in the list. */
function letChoose(overlay, canvas, page) {
  const { store } = page;
  const isMine = () => store.get("now").who === "mine";
  const choose = (n) => isMine() && pressObject(store.get("scene")?.objects[n], page);
  store.subscribe("now", () => overlay.setChooser(isMine() ? choose : null));
  watchPointing(canvas, {
    find: (point) => overlay.at(point),
    hover: (n) => {
      overlay.hover(n);
      canvas.classList.toggle("arm-choosable", n >= 0 && isMine());
    },
    choose,
  });
}

/** Has the picture follow the page: its size, its theme, whether it is seen, and who looks at it. */
function watch(picture, { stage, canvas, buttons }, overlay) {
  watchTheme(stage, (dark) => picture.call("setTheme", dark));
  watchSize(stage, (size) => {
    overlay.setSize(size);
    picture.call("setSize", size);
  });
  watchSeen(stage, (seen) => picture.call("setSeen", seen));
  forwardInput(stage, canvas, (what, ...args) => picture.call(what, ...args));
  for (const button of buttons.filter(({ dataset }) => VIEWS.includes(dataset.view ?? ""))) {
    button.addEventListener("click", () => picture.call("look", button.dataset.view, calm()));
  }
}

/** Has the robot be drawn as it is described. */
function drawRobot(picture, element, { notice }, link, t) {
  const use = async (tree) => {
    await picture.ask("setRobot", tree);
    element.dataset.state = "ready";
  };
  followDescription(link, use, (why, isKnown) => {
    notice.hidden = isKnown;
    notice.textContent = t("arm.no_robot", { why });
  });
}
