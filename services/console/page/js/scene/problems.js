// @ts-check
import { h } from "../dom.js";
import { about, proposedPlace } from "./document.js";

/**
 * Every problem of the scene, each with a link to its subject and, if one is proposed, its move.
 * @param {any} t
 * @param {object} does
 * @param {(what: {kind: string, n: number}) => void} does.go
 * @param {(n: number, place: number[]) => void} does.move
 */
export function problemsView(t, { go, move }) {
  const state = h("p", { class: "check-state", role: "status" });
  const list = h("ul", { class: "problems", "aria-label": t("scene.problems.label") });
  const warnings = h("ul", { class: "problems warnings", "aria-label": t("scene.warnings") });
  const element = h("div", { class: "scene-check" }, state, list, warnings);

  /**
   * @param {object} findings
   * @param {"checking"|"failed"|"done"|"idle"} findings.state
   * @param {any[]} findings.problems
   * @param {string[]} findings.warnings
   * @param {string} [findings.error]
   * @param {boolean} canEdit
   */
  function draw({ state: is, problems, warnings: unclear, error }, canEdit) {
    const n = problems.length;
    const key = is === "done" && n > 0 ? "scene.problems" : `scene.check.${is}`;
    state.textContent = is === "failed" ? (error ?? "") : t(key, { n });
    element.dataset.state = is === "done" && n > 0 ? "wrong" : is;
    list.replaceChildren(...problems.map((problem) => row(problem, canEdit)));
    warnings.replaceChildren(...unclear.map((text) => h("li", { text })));
  }

  function row(problem, canEdit) {
    const what = about(problem);
    const words = h("span", { class: "problem-what", text: problem.what });
    const help = problem.cure ? h("span", { class: "problem-help", text: problem.cure }) : null;
    const onclick = () => go(what);
    const body =
      what.kind === "scene"
        ? h("div", { class: "problem" }, words, help)
        : h("button", { type: "button", class: "problem", onclick }, words, help);
    const place = what.kind === "object" && canEdit ? proposedPlace(problem) : null;
    const there = place && {
      type: "button",
      class: "small",
      onclick: () => move(what.n, place),
      text: t("scene.move"),
    };
    return h("li", { "data-key": problem.key }, body, there ? h("button", there) : null);
  }
  return { element, draw };
}
