// @ts-check
import { h, keyed, setAttribute, setText } from "../dom.js";
import { icon } from "../icons.js";
import { readable } from "../model/ranking.js";
import { placesIn, shownAt, step } from "./model.js";

/** Most bars; of more objects the likeliest are shown. */
const BARS_MAX = 14;

/**
 * The elements of the history.
 * @param {any} t
 * @param {(place: import("./model.js").Place) => void} go
 */
export function buildView(t, go) {
  const list = h("ol", { class: "past-list", "aria-label": t("history.list") });
  const line = h("ol", { class: "timeline", "aria-label": t("history.timeline") });
  const when = h("p", { class: "past-when" });
  const talk = h("div", { class: "past-talk" });
  const bars = h("ul", { class: "past-bars", "aria-label": t("history.belief") });
  const empty = h("p", { class: "empty" });
  const turn = (by) => () => go(step(now.history, now.at, by));
  const back = h(
    "button",
    { type: "button", onclick: turn(-1) },
    icon("before"),
    t("history.before"),
  );
  const on = h("button", { type: "button", onclick: turn(1) }, t("history.after"), icon("after"));
  const detail = h(
    "div",
    { class: "past-detail" },
    line,
    h("div", { class: "past-step", role: "status" }, when, talk),
    bars,
    h("div", { class: "past-walk" }, back, on),
  );
  const body = h("div", { class: "past" }, list, detail);
  /** @type {{history: import("./model.js").Past[], at: import("./model.js").Place}} */
  let now = { history: [], at: { interaction: 0, step: 0 } };
  let isFailed = false;

  function draw(history, at) {
    now = { history, at };
    body.hidden = history.length === 0;
    setText(empty, history.length ? "" : t(isFailed ? "history.unavailable" : "history.none"));
    empty.hidden = history.length > 0;
    const newestFirst = history.toReversed();
    const make = (past) => pastButton(past, go);
    keyed(
      list,
      newestFirst,
      (past) => past.interaction,
      make,
      (node, past) => fillPast(node, past, past.interaction === at.interaction, t),
    );
    const shown = shownAt(history, at);
    if (!shown) return;
    drawTimeline(line, shown.past, at, t, go);
    drawStep(when, talk, shown, at, t);
    drawBars(bars, shown, t);
    const is = (a, b) => a.interaction === b.interaction && a.step === b.step;
    // Not `disabled`: the focus stays on them, and with it the keys.
    setAttribute(back, "aria-disabled", is(step(history, at, -1), at) ? "true" : null);
    setAttribute(on, "aria-disabled", is(step(history, at, 1), at) ? "true" : null);
  }
  const fail = (failed) => {
    isFailed = failed;
  };
  return { element: h("div", {}, empty, body), draw, fail };
}

function pastButton(past, go) {
  const onclick = () => go({ interaction: past.interaction, step: 0 });
  const what = h("span", { class: "past-what" });
  const more = h("span", { class: "past-more" });
  return h("li", {}, h("button", { type: "button", class: "past-one", onclick }, what, more));
}

function fillPast(node, past, isCurrent, t) {
  const [what, more] = node.firstElementChild.children;
  setAttribute(node.firstElementChild, "aria-current", isCurrent ? "true" : null);
  setText(what, headline(past, t));
  setText(more, [clock(past.unix_ms, t), summary(past, t)].filter(Boolean).join(" · "));
}

function headline({ end }, t) {
  if (!end) return t("history.open");
  return t(`history.${end.outcome}`, { object: end.object ?? "" });
}

const summary = ({ end }, t) =>
  end ? t("history.effort", { n: end.questions, seconds: t.number(end.seconds, ONE_DIGIT) }) : "";

const ONE_DIGIT = { maximumFractionDigits: 1 };

function clock(unix_ms, t) {
  const form = { hour: "2-digit", minute: "2-digit", hourCycle: "h23" };
  return new Date(unix_ms).toLocaleTimeString(t.language(), form);
}

function drawTimeline(line, past, at, t, go) {
  const n = placesIn(past);
  const places = Array.from({ length: n }, (_, k) => ({ k, id: `${past.interaction}.${k}` }));
  const make = ({ k }) => {
    const onclick = () => go({ interaction: past.interaction, step: k });
    return h("li", {}, h("button", { type: "button", class: "timeline-dot", onclick }));
  };
  keyed(
    line,
    places,
    ({ id }) => id,
    make,
    (node, { k }) => {
      const dot = node.firstElementChild;
      const isEnd = k === past.steps.length;
      setAttribute(dot, "data-kind", isEnd ? "end" : past.steps[k].decision);
      setAttribute(
        dot,
        "aria-label",
        isEnd ? t("history.end") : t("history.step", { k: k + 1, of: n }),
      );
      setAttribute(dot, "aria-current", k === at.step ? "step" : null);
    },
  );
}

function drawStep(when, talk, { past, step, isEnd }, at, t) {
  const places = placesIn(past);
  const label = isEnd ? t("history.end") : t("history.step", { k: at.step + 1, of: places });
  const after = isEnd ? (past.end?.seconds ?? 0) : (step?.after_ms ?? 0) / 1_000;
  setText(when, `${label} · ${t("history.since", { seconds: t.number(after, ONE_DIGIT) })}`);
  const said = (who, text) =>
    h("p", { class: "past-line", "data-who": who }, h("b", { text: `${t(`who.${who}`)}: ` }), text);
  const heard = (step?.heard ?? []).filter(({ text }) => text);
  const lines = isEnd
    ? [h("p", { class: "past-line past-end", text: `${headline(past, t)}. ${summary(past, t)}.` })]
    : [
        ...heard.map(({ text }) => said("person", text)),
        step?.text ? said("robot", step.text) : null,
      ].filter((line) => line !== null);
  const text = lines.map((line) => line.textContent).join("\n");
  if (talk.dataset.text === text) return;
  talk.dataset.text = text;
  talk.replaceChildren(...lines);
}

function drawBars(bars, { past, step, before }, t) {
  const all = past.objects.map((label, n) => ({ n, label, p: step?.belief[n] ?? 0 }));
  const likely = all.toSorted((a, b) => b.p - a.p).slice(0, BARS_MAX);
  const shown = likely.toSorted((a, b) => a.n - b.n);
  const make = () => {
    const bar = h("span", { class: "bar", "aria-hidden": "true" }, h("span", {}), h("i", {}));
    return h("li", {}, h("span", { class: "bar-name" }), bar, h("span", { class: "bar-share" }));
  };
  const most = Math.max(...shown.map(({ p }) => p), 0);
  keyed(
    bars,
    shown,
    ({ n }) => `${past.interaction}.${n}`,
    make,
    (node, { n, label, p }) => {
      const [name, bar, share] = node.children;
      const { sign, share: part } = readable(p);
      setText(name, label);
      setText(share, sign + t.percent(part));
      bar.firstElementChild.style.setProperty("inline-size", `${100 * p}%`);
      // Where it was a step before.
      bar.lastElementChild.style.setProperty("inset-inline-start", `${100 * (before?.[n] ?? p)}%`);
      setAttribute(bar.lastElementChild, "data-moved", Math.abs((before?.[n] ?? p) - p) > 0.005);
      setAttribute(node, "data-best", p === most && p > 0);
    },
  );
}
