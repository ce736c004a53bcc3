// @ts-check
import { h, setText } from "../dom.js";
import { keptLanguage } from "../kept.js";
import { chooseLanguage, loadStrings, t, translate } from "../strings.js";
import { interactionOf } from "./model.js";
import { oneView } from "./one.js";

/** Largest file, bytes: many times the size of an interaction. */
const FILE_MAX = 32 << 20;

await loadStrings(chooseLanguage(location.search, keptLanguage(), navigator.languages));
translate(document);

const main = /** @type {HTMLElement} */ (document.getElementById("main"));
const one = oneView(t, [], "h2");
const state = h("p", { class: "past-drop-state", role: "status" });
const pick = h("input", { type: "file", accept: ".json,application/json", id: "file" });
const label = h("label", { class: "past-pick", for: "file", text: t("history.choose") });
const drop = h(
  "section",
  { class: "past-drop" },
  h("p", { text: t("history.drop") }),
  pick,
  label,
  state,
);
main.append(drop, one.element);
document.documentElement.dataset.ready = "";

pick.addEventListener("change", () => open(pick.files?.[0]));
addEventListener("dragover", (event) => event.preventDefault());
addEventListener("drop", (event) => {
  event.preventDefault();
  open(event.dataTransfer?.files[0]);
});
addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || event.target === pick) return;
  const inStory = /** @type {Element} */ (event.target).closest?.(".story") != null;
  if (one.onKey(event, inStory)) event.preventDefault();
});

// `whichone console --view FILE` names its file so.
const shared = new URLSearchParams(location.search).get("shared");
if (shared?.startsWith("/shared/")) {
  const response = await fetch(shared).catch(() => null);
  show(response?.ok ? await response.text() : "", t("history.shared"));
}

/** Shows the interaction in a file. @param {File|undefined} file */
async function open(file) {
  if (file) show(file.size <= FILE_MAX ? await file.text() : "", file.name);
}

/** @param {string} text @param {string} name */
function show(text, name) {
  const past = interactionOf(text);
  drop.toggleAttribute("data-open", past !== null);
  one.show(past);
  setText(state, past ? name : t("history.not_one", { name }));
}
