// @ts-check
import { h, keyed, setAttribute, setText } from "../dom.js";
import { endWords } from "./model.js";

/**
 * The list of interactions, newest first, by days. More are asked for before its end comes into sight.
 * @param {any} t
 * @param {{choose: (interaction: number) => void, more: () => void}} actions
 */
export function listView(t, { choose, more }) {
  const list = h("ol", { class: "past-list", "aria-label": t("history.list") });
  const reach = h("p", { class: "past-reach" });
  const end = h("div", { class: "past-more-here", "aria-hidden": "true" });
  const element = h(
    "nav",
    { class: "past-nav", "aria-label": t("history.list") },
    list,
    end,
    reach,
  );
  const sight = { root: element, rootMargin: "600px" };
  new IntersectionObserver(([seen]) => seen.isIntersecting && more(), sight).observe(end);

  /**
   * @param {import("./source.js").Source} source
   * @param {number} current
   */
  function draw(source, current) {
    const rows = withDays(source.list, t);
    const isRoving = !source.list.some(({ interaction }) => interaction === current);
    keyed(
      list,
      rows,
      (row) => row.key,
      (row) => (row.day ? dayRow(row.day) : pastButton(row.past, choose)),
      (node, row) => {
        if (row.past) fill(node, row.past, row.past.interaction === current, t);
      },
    );
    // One stop for Tab: the chosen one, or the first.
    if (isRoving) list.querySelector("button")?.setAttribute("tabindex", "0");
    end.hidden = source.isComplete;
    setText(reach, reachWords(source, t));
  }
  /** Brings the chosen one into sight, with the focus if wanted. */
  function reveal(focus) {
    const current = list.querySelector('[aria-current="true"]');
    if (!(current instanceof HTMLElement)) return;
    current.scrollIntoView({ block: "nearest" });
    if (focus) current.focus({ preventScroll: true });
  }
  return { element, draw, reveal };
}

/** The interactions, and before the first of each day the day. */
function withDays(list, t) {
  const rows = [];
  let before = "";
  for (const past of list) {
    const day = dayOf(past.unix_ms, t);
    if (day !== before) rows.push({ key: `day ${day}`, day, past: null });
    before = day;
    rows.push({ key: past.interaction, day: null, past });
  }
  return rows;
}

const dayRow = (day) => h("li", { class: "past-day", text: day });

function pastButton(past, choose) {
  const onclick = () => choose(past.interaction);
  const children = ["past-time", "past-what", "past-words", "past-effort"].map((name) =>
    h("span", { class: name }),
  );
  return h("li", {}, h("button", { type: "button", class: "past-one", onclick }, ...children));
}

function fill(node, past, isCurrent, t) {
  const button = node.firstElementChild;
  const [time, what, words, effort] = button.children;
  setAttribute(button, "aria-current", isCurrent ? "true" : null);
  setAttribute(button, "tabindex", isCurrent ? "0" : "-1");
  setAttribute(button, "data-outcome", past.end?.outcome ?? "open");
  const { key, args } = endWords(past.end);
  setText(time, timeOf(past.unix_ms, t));
  setText(what, t(key, args));
  setText(words, past.text ? `“${past.text}”` : "");
  setText(effort, effortOf(past.end, t));
}

const ONE_DIGIT = { maximumFractionDigits: 1 };

/** "2 questions, 14 s" @param {import("./model.js").End|null} end @param {any} t */
export const effortOf = (end, t) =>
  end
    ? t("history.effort", { n: end.questions, seconds: t.number(end.duration_s, ONE_DIGIT) })
    : "";

/** The time of day; none if unknown. */
export function timeOf(unix_ms, t) {
  if (unix_ms === null) return "–";
  const form = { hour: "2-digit", minute: "2-digit", hourCycle: "h23" };
  return new Date(unix_ms).toLocaleTimeString(t.language(), form);
}

/** The day in words, relative if recent. */
export function dayOf(unix_ms, t, now = Date.now()) {
  if (unix_ms === null) return t("history.day.unknown");
  const midnight = (ms) => new Date(ms).setHours(0, 0, 0, 0);
  const days = Math.round((midnight(now) - midnight(unix_ms)) / 86_400_000);
  if (days === 0) return t("history.day.today");
  if (days === 1) return t("history.day.yesterday");
  const form = { weekday: "long", day: "numeric", month: "long", year: "numeric" };
  return new Date(unix_ms).toLocaleDateString(t.language(), form);
}

/** How many there are, and how far back they go. */
function reachWords({ total, oldest }, t) {
  if (!oldest) return "";
  const since = oldest.unix_ms === null ? t("history.day.unknown") : dateOf(oldest.unix_ms, t);
  return t("history.reach", { n: total, since });
}

function dateOf(unix_ms, t) {
  const form = { dateStyle: "medium", timeStyle: "short" };
  return new Date(unix_ms).toLocaleString(t.language(), form);
}
