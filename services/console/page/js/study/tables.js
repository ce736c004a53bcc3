// @ts-check
import { h } from "../dom.js";
import { pairedCells, policyCells } from "./numbers.js";

/**
 * The results as tables.
 * @param {any} report
 * @param {any} t
 * @returns {HTMLElement[]}
 */
export function reportView(report, t) {
  const people = Object.entries(report.participants).filter(([, count]) => count > 0);
  if (people.length === 0) return [h("p", { class: "empty", text: t("study.results.none") })];
  const counts = people.map(([status, count]) =>
    h("span", { text: `${t.number(count)} ${t(`study.people.${status}`)}` }),
  );
  const parts = [h("p", { class: "results-people" }, ...counts), policies(report, t)];
  if (report.paired.length > 0) parts.push(paired(report, t));
  parts.push(h("p", { class: "results-note", text: t("study.table.note") }));
  if (report.faults > 0) {
    parts.push(h("p", { class: "results-note", text: t("study.faults", { n: report.faults }) }));
  }
  if (report.scenes.length > 1) {
    const names = report.scenes.map((scene) => `${scene.name} (${scene.key})`).join(", ");
    parts.push(h("p", { class: "results-warn", text: t("study.scenes", { names }) }));
  }
  return parts;
}

function policies(report, t) {
  const heads = ["policy", "people", "interactions", "success", "seconds", "questions"];
  const groups = report.policies.length > 1 ? [...report.policies, report.all] : report.policies;
  const name = (group) => (group === report.all ? t("study.table.all") : group.policy);
  const rows = groups.map((group) => row(name(group), policyCells(group, t)));
  return table(t("study.table"), heads, rows, t);
}

function paired(report, t) {
  const heads = ["policy", "people", "success", "seconds", "questions"];
  const rows = report.paired.map((one) => {
    const { policy, with: other } = one;
    return row(t("study.paired.less", { policy, with: other }), pairedCells(one, t));
  });
  return table(t("study.paired"), heads, rows, t);
}

function table(caption, heads, rows, t) {
  const head = heads.map((key) => h("th", { scope: "col", text: t(`study.table.${key}`) }));
  return h(
    "div",
    { class: "results-scroll", tabindex: 0, role: "region", "aria-label": caption },
    h(
      "table",
      {},
      h("caption", { text: caption }),
      h("thead", {}, h("tr", {}, ...head)),
      h("tbody", {}, ...rows),
    ),
  );
}

function row(name, cells) {
  const written = cells.map(([value, interval]) =>
    h("td", {}, value, interval ? h("small", { text: interval }) : null),
  );
  return h("tr", {}, h("th", { scope: "row", text: name }), ...written);
}
