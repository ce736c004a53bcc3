// @ts-check
import { eachFrame, h, keyed, setAttribute, setText } from "../dom.js";
import { duration } from "./duration.js";

/** The stages of an answer, in their order. */
const STAGES = ["heard", "understood", "decided", "spoken"];

/**
 * Shows the robot's response time by stage, from the end of speech to the first sound.
 * @param {HTMLElement} element
 * @param {{store: any, t: any}} context
 */
export function mountLatency(element, { store, t }) {
  const title = h("p", { class: "latency-title" });
  const bar = h("div", { class: "latency-bar", "aria-hidden": "true" });
  const list = h("dl", { class: "latency-list" });
  element.append(title, bar, list);
  const time = (ms) => duration(ms, t);

  const draw = eachFrame(() => {
    const latency = store.get("latency");
    const shown = latency?.count > 0;
    element.hidden = !shown;
    if (!shown) return;
    const { last = {}, p50 = {}, p99 = {}, count } = latency;
    setText(title, t("latency.title", { n: count, total: time(p50.total_ms) }));
    const stages = STAGES.map((stage) => ({ stage, key: `${stage}_ms` }));
    const total = stages.reduce((sum, { key }) => sum + (p50[key] ?? 0), 0);
    keyed(
      bar,
      stages,
      ({ stage }) => stage,
      ({ stage }) => h("span", { class: "stage", "data-stage": stage }),
      (node, { key }) => {
        const share = total > 0 ? (p50[key] ?? 0) / total : 0;
        node.style.setProperty("flex-grow", share.toFixed(4));
      },
    );
    const rows = [...stages, { stage: "total", key: "total_ms" }];
    keyed(
      list,
      rows,
      ({ stage }) => stage,
      makeRow,
      (node, { stage, key }) => {
        setAttribute(node, "data-stage", stage);
        const words = t("latency.row", {
          last: time(last[key]),
          p50: time(p50[key]),
          p99: time(p99[key]),
        });
        setText(node.lastElementChild, words);
      },
    );
  });
  const makeRow = ({ stage }) =>
    h("div", {}, h("dt", { text: t(`latency.${stage}`) }), h("dd", {}));
  store.subscribe("latency", draw);
  draw();
}
