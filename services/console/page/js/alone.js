// @ts-check
// For the pages that stand alone: the same words in the person's language.
import { keptLanguage } from "./kept.js";
import { chooseLanguage, loadStrings, translate } from "./strings.js";

const wrong = document.getElementById("wrong");
if (wrong) wrong.hidden = !new URLSearchParams(location.search).has("wrong");
await loadStrings(chooseLanguage(location.search, keptLanguage(), navigator.languages));
translate(document);
