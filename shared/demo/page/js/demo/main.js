import { armWords } from "../arm/words.js";
import { keepDelivery } from "../delivery.js";
import { eachFrame, h, setText } from "../dom.js";
import { icon } from "../icons.js";
import { keptLanguage } from "../kept.js";
import { Hold } from "../model/hold.js";
import { keepNow } from "../now.js";
import { stopper } from "../stop.js";
import { keep, Store } from "../store.js";
import { chooseLanguage, loadStrings, t, translate } from "../strings.js";
import { mountActions } from "../views/actions.js";
import { mountCards } from "../views/cards.js";
import { mountQuestion } from "../views/question.js";
import { mountResume } from "../views/resume.js";
import { mountSay } from "../views/say.js";
import { mountTranscript } from "../views/transcript.js";
import { mountWhy } from "../views/why.js";
import { loadRobot } from "./robot.js";
import { mountTable } from "./table.js";

const MODULE = new URL("../../whichone.wasm", import.meta.url);

/** @param {string} id */
const at = (id) => document.getElementById(id);

const language = chooseLanguage(location.search, keptLanguage(), navigator.languages);
const [robot] = await Promise.all([
  loadRobot(MODULE).catch(() => null),
  loadStrings(language, ["demo"]),
]);
translate(document);
document.title = t("demo.title");
if (robot) begin(robot);
else complain(t("demo.missing"));

/** Shows an error above everything. @param {string} text */
function complain(text) {
  at("trouble").textContent = text;
  at("trouble").hidden = false;
}

/** @param {import("./robot.js").Robot} robot */
function begin(robot) {
  const store = new Store();
  const stop = stopper({ link: robot, store });
  keep(store, robot);
  keepDelivery({ link: robot, store });
  const context = { link: robot, store, t, stop, hold: new Hold(), grows: true };
  keepNow(context);
  mountActions(at("actions"), context);
  mountResume(at("resume"), context);
  mountQuestion(at("question"), context);
  mountSay(at("say"), context);
  mountTable(at("table"), context);
  mountCards(at("cards"), context);
  mountWhy(at("why"), context);
  mountTranscript(at("transcript"), context);
  sayArm(at("arm"), store);
  sayLines(at("polite"), store);
  robot.on("broken", (error) => complain(t("demo.broken", { why: error.message })));

  const names = robot.scenes();
  const scenes = at("scene");
  scenes.append(
    ...names.map((name) => h("option", { value: name, text: t(`demo.scene.${name}`) })),
  );
  const wished = new URLSearchParams(location.search).get("scene") ?? "";
  scenes.value = names.includes(wished) ? wished : names[0];
  const open = () => {
    store.set("lines", []);
    store.set("settled", undefined);
    store.set("delivery", null);
    store.set("belief", null);
    robot.open(scenes.value);
  };
  scenes.addEventListener("change", open);
  at("again").append(icon("again", 17), t("demo.again"));
  at("again").addEventListener("click", () => {
    open();
    at("say-text").focus();
  });
  open();
  document.documentElement.dataset.ready = "";
}

/** What the arm does, in words. */
function sayArm(element, store) {
  const draw = eachFrame(() => {
    const [now, arm, scene] = [store.get("now"), store.get("arm"), store.get("scene")];
    if (arm && scene) setText(element, armWords(now, arm, scene, null, t));
  });
  store.subscribe(["now", "arm", "scene"], draw);
}

/** The robot's lines for those who hear the page. */
function sayLines(element, store) {
  let last = 0;
  store.subscribe("lines", (lines) => {
    const newest = lines.at(-1)?.id ?? 0;
    if (newest < last) last = 0;
    const fresh = lines.filter(({ id, who }) => id > last && who === "robot");
    last = newest;
    if (fresh.length > 0) element.textContent = fresh.map(({ text }) => text).join(" ");
  });
  store.subscribe("now", ({ is, atRest }) => {
    if (is === "stopped" && atRest) element.textContent = t("turn.stopped");
  });
}
