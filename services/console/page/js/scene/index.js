// @ts-check
import { eachFrame, h, setAttribute, setText } from "../dom.js";
import { icon } from "../icons.js";
import { notify } from "../views/attempt.js";
import { Refused, scenesApi } from "./api.js";
import { addObject, freeName, freeSpot, rounded } from "./document.js";
import { Draft } from "./draft.js";
import { nearest } from "./geometry.js";
import { keepDraft, keptDraft } from "./kept_draft.js";
import { objectPanel } from "./object_panel.js";
import { about, problemsView } from "./problems.js";
import { ReachMap, reachKey } from "./reach.js";
import { topView } from "./top.js";
import { wordsPanel } from "./words_panel.js";

/** Time without a change after which the scene is checked, and the reach is asked for, milliseconds. */
const REST_MS = 350;
/** Longest wait for the group to come back with another scene, milliseconds. */
const SWITCH_MS = 40_000;
/** Maps of the reach that are kept. */
const MAPS_MAX = 24;

/**
 * The scene editor: a sheet with the table from above, the chosen object, the words, and every problem.
 * @param {{store: any, t: any, session: string}} context
 * @returns {Promise<() => void>} opens it
 */
export async function mountScene({ store, t, session }) {
  await loadStyle();
  const api = scenesApi(session);
  /** @type {Draft|null} */
  let draft = null;
  let robot = null;
  let listed = { names: [], in_force: "", in_force_hash: "", locked: null };
  /** @type {number|null} */
  let chosen = null;
  let panel = "object";
  let findings = { state: "idle", problems: [], warnings: [], words: [] };
  let isBusy = false;
  /** @type {Map<string, ReachMap>} */
  const maps = new Map();
  let reachAsked = new AbortController();
  let checkAsked = new AbortController();
  let restTimer = 0;
  /** @type {{key: string, element: HTMLElement, show: () => void, reveal?: (k: number) => void}|null} */
  let form = null;

  const canEdit = () => {
    const operator = store.get("control")?.operator ?? null;
    const isOperator = operator !== null && operator === store.get("welcome")?.viewer;
    return isOperator && draft !== null && !isBusy;
  };
  const documentNow = () => draft?.document ?? { noun: "", attributes: [], objects: [] };
  const change = (f, what = "") => {
    if (!canEdit()) return undefined;
    const result = draft.change(f, what);
    changed();
    return result;
  };
  const changeObject = (n, f, what) => change((document) => f(document.objects[n]), what);
  const top = topView(t, { choose, change: changeObject, settle: () => draft?.settle() });
  const problems = problemsView(t, {
    go: ({ kind, n }) => (kind === "object" ? goTo(n) : showWords(n)),
    move: (n, place) => changeObject(n, (object) => Object.assign(object, { xyz: place }), ""),
  });

  const select = h("select", { "aria-label": t("scene.which"), onchange: () => open(select.value) });
  const name = h("input", {
    type: "text",
    id: "scene-name",
    autocomplete: "off",
    spellcheck: "false",
    pattern: "[A-Za-z0-9][A-Za-z0-9_\\-]{0,63}",
    "aria-label": t("scene.name"),
    oninput: () => draw(),
  });
  const fresh = textButton("scene.new", "plus", () => open(null));
  const undo = iconButton("scene.undo", "undo", () => step("undo"));
  const redo = iconButton("scene.redo", "redo", () => step("redo"));
  const save = h("button", { type: "button", class: "small", onclick: () => saveDraft() });
  const use = h("button", { type: "button", class: "small primary", onclick: () => useScene() });
  const note = h("p", { class: "scene-note", role: "status" });
  const status = h("p", { class: "thing-state", "aria-live": "polite" });
  const things = h("div", { class: "thing-list", role: "group", "aria-label": t("scene.objects") });
  const add = textButton("scene.add", "plus", () => addThing(null));
  const copy = textButton("scene.copy", "copy", () => addThing(chosen));
  const drop = textButton("scene.remove", "close", removeThing);
  const tabs = ["object", "words"].map((which) =>
    h("button", {
      type: "button",
      "data-panel": which,
      onclick: () => show(which),
      text: t(`scene.panel.${which}`),
    }),
  );
  const body = h("div", { class: "scene-panel" });
  const close = iconButton("scene.close", "close", () => dialog.close());
  const dialog = h(
    "dialog",
    { class: "help scene", "aria-labelledby": "scene-title", tabindex: "-1" },
    h(
      "div",
      { class: "help-head" },
      h("h2", { id: "scene-title", text: t("scene.title") }),
      h("div", { class: "scene-files" }, select, fresh, undo, redo, name, save, use),
      close,
    ),
    note,
    h(
      "div",
      { class: "scene-body" },
      h(
        "div",
        { class: "scene-picture" },
        top.element,
        status,
        h("p", { class: "scene-keys", text: t("scene.keys") }),
        problems.element,
      ),
      h(
        "div",
        { class: "scene-side" },
        h("nav", { class: "scene-tabs", "aria-label": t("scene.panels") }, ...tabs),
        h("div", { class: "row" }, add, copy, drop),
        things,
        body,
      ),
    ),
  );
  dialog.addEventListener("close", () => store.set("cover", null));
  dialog.addEventListener("keydown", onKey);
  document.body.append(dialog);
  addEventListener("beforeunload", (event) => {
    if (dialog.open && draft?.isChanged) event.preventDefault();
  });

  function textButton(key, drawing, onclick) {
    return h("button", { type: "button", class: "small", onclick }, icon(drawing, 18), t(key));
  }
  function iconButton(key, drawing, onclick) {
    const about = { type: "button", class: "tool", "aria-label": t(key), title: t(key), onclick };
    return h("button", about, icon(drawing, 22));
  }

  function onKey(event) {
    const isText = event.target.matches?.("input, textarea, select");
    if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === "z" && !isText) {
      step(event.shiftKey ? "redo" : "undo");
    } else if (event.key === "Delete" && event.target.closest?.(".thing, .thing-list")) {
      removeThing();
    } else return;
    event.preventDefault();
  }
  function step(which) {
    if (!canEdit()) return;
    draft[which]();
    changed();
  }
  function choose(n) {
    if (chosen === n) return;
    chosen = n;
    if (panel !== "object") panel = "object";
    rest();
    draw();
  }
  function goTo(n) {
    choose(n);
    show("object");
    top.focus(n);
  }
  function show(which) {
    panel = which;
    draw.now();
  }
  function showWords(n) {
    show("words");
    if (n >= 0) form?.reveal?.(n);
  }
  function addThing(like) {
    const n = change((document) => {
      const spot = (size, z) => spotFor(document, size, z);
      return addObject(document, like, { spot, table_z_m: robot.table_z_m });
    });
    if (n !== undefined) goTo(n);
  }
  function spotFor({ objects }, size, z) {
    const [x] = robot.hand_over_xyz_m;
    const map = reachNow();
    const reaches = (px, py) => (map?.at(px, py) ?? "") !== null;
    return freeSpot(objects, size, z, { middle: [rounded(x - 0.1), 0], reaches });
  }
  function removeThing() {
    if (chosen === null) return;
    const gone = chosen;
    change((document) => document.objects.splice(gone, 1));
    const left = documentNow().objects.length;
    chosen = left === 0 ? null : Math.min(gone, left - 1);
    draw.now();
    if (chosen !== null) top.focus(chosen);
  }

  /** After each change: the check waits until nothing changes any more. */
  function changed() {
    if (chosen !== null && !documentNow().objects[chosen]) chosen = null;
    findings = { ...findings, state: "checking" };
    rest();
    draw();
  }
  function rest() {
    clearTimeout(restTimer);
    restTimer = setTimeout(() => {
      check();
      fillReach();
      keepDraft(draft?.isChanged ? draft : null);
    }, REST_MS);
  }
  let checked = "";
  async function check() {
    if (!canEdit() || !draft) return;
    const { text, document } = draft;
    const now = JSON.stringify([text, document]);
    if (now === checked && findings.state !== "checking") return;
    checkAsked.abort();
    checkAsked = new AbortController();
    const { signal } = checkAsked;
    try {
      const found = await api.check({ text, document }, signal);
      checked = now;
      findings = { ...found, state: "done" };
    } catch (error) {
      if (signal.aborted) return;
      findings = { state: "failed", problems: error.problems ?? [], warnings: [], words: [] };
      findings = { ...findings, ...{ error: error.message } };
    }
    draw();
  }
  const reachNow = () => maps.get(reachKey(documentNow().objects[chosen ?? -1])) ?? null;
  async function fillReach() {
    const object = documentNow().objects[chosen ?? -1];
    const key = reachKey(object);
    if (!key || !canEdit() || maps.get(key)?.isComplete) return;
    reachAsked.abort();
    reachAsked = new AbortController();
    const { signal } = reachAsked;
    const map = maps.get(key) ?? new ReachMap();
    maps.delete(key);
    maps.set(key, map);
    for (const old of [...maps.keys()].slice(0, -MAPS_MAX)) maps.delete(old);
    try {
      await map.fill(object, (one, at) => api.reach(one, at, signal), draw);
    } catch {
      // Another object was chosen; or the server refuses this one, as the check says.
    }
  }

  /** Opens a scene, null for a new one. */
  async function open(which) {
    const isLost = draft?.isChanged && !confirm(t("scene.discard"));
    if (isLost) return draw();
    await attempt(async () => {
      take(which === null ? await api.create() : await api.open(which));
    });
  }
  function take(opened) {
    draft = new Draft(opened);
    robot = opened.robot;
    maps.clear();
    chosen = null;
    form = null;
    name.value = opened.name ?? freeName(listed.names.map((one) => ({ name: one })), "scene");
    findings = { state: "checking", problems: [], warnings: [], words: [] };
    panel = opened.document.objects.length === 0 ? "words" : "object";
    if (opened.document.objects.length > 0) chosen = 0;
    rest();
  }
  async function saveDraft() {
    if (!canEdit() || !name.reportValidity() || !draft) return;
    const wished = name.value.trim();
    const isOwn = wished === draft.name;
    if (draft.name === null || !isOwn) draft.document = { ...draft.document, name: wished };
    const { text, document } = draft;
    const known = isOwn ? draft.hash : null;
    await attempt(async () => {
      const saving = { text, document, known, draft: findings.problems.length > 0 };
      const saved = await api.save(wished, saving);
      draft?.setSaved(saved);
      const { problems: found, warnings, words } = saved;
      findings = { state: "done", problems: found, warnings, words };
      checked = JSON.stringify([saved.text, saved.document]);
      keepDraft(null);
      listed = await api.list();
      notify(t("scene.saved", { name: wished }));
    });
  }
  async function useScene() {
    if (!canEdit() || !draft?.name) return;
    const wished = draft.name;
    await attempt(async () => {
      setText(note, t("scene.switching", { name: wished }));
      try {
        await api.use(wished);
      } catch (error) {
        // The console is restarted with the others: its answer may be lost.
        if (error instanceof Refused) throw error;
      }
      await untilInForce(draft?.hash);
      notify(t("scene.used", { name: wished }));
    });
  }
  async function untilInForce(hash) {
    const end = Date.now() + SWITCH_MS;
    while (Date.now() < end) {
      try {
        listed = await api.list();
        if (listed.in_force_hash === hash) return;
      } catch {
        // It is restarting.
      }
      await new Promise((resolve) => setTimeout(resolve, 300));
    }
    throw new Error(t("scene.not_switched"));
  }
  /** Does something with the server; says what went wrong. */
  async function attempt(work) {
    isBusy = true;
    draw();
    setText(note, "");
    try {
      await work();
      setText(note, "");
    } catch (error) {
      setText(note, error instanceof TypeError ? t("scene.unavailable") : error.message);
      if (error.problems?.length) {
        findings = { state: "done", problems: error.problems, warnings: [], words: [] };
      }
    }
    isBusy = false;
    rest();
    draw();
  }

  function drawForm() {
    const { objects, attributes } = documentNow();
    const structure = attributes.map(({ values }) => values.length);
    const names = attributes.map(({ name: one, values }) => [one, values.map((it) => it.name)]);
    const key = JSON.stringify(panel === "words" ? ["words", structure] : [chosen, names]);
    if (form?.key === key) return form.show();
    if (panel === "words") {
      form = { key, ...wordsPanel(t, documentNow, change) };
    } else if (chosen === null || !objects[chosen]) {
      const text = t(objects.length === 0 ? "scene.empty" : "scene.none_chosen");
      form = { key, element: h("p", { class: "empty", text }), show: () => {} };
    } else {
      const spot = () => {
        const z = rounded(robot.table_z_m + 0.025);
        return /** @type {[number, number, number]} */ ([
          ...spotFor(documentNow(), [0.1, 0.03, 0.05], z),
          z,
        ]);
      };
      form = { key, ...objectPanel(t, documentNow, chosen, { change, spot }) };
    }
    body.replaceChildren(form.element);
  }
  function drawList(wrong) {
    const { objects } = documentNow();
    const buttons = objects.map(({ name: one }, n) =>
      h("button", {
        type: "button",
        class: "small",
        "aria-pressed": String(n === chosen),
        "data-wrong": wrong.has(n),
        onclick: () => goTo(n),
        text: one || t("scene.nameless"),
      }),
    );
    const has = [...things.children].map((node) => node.outerHTML).join();
    // A pressed button must not be replaced under the pointer.
    if (has !== buttons.map((node) => node.outerHTML).join()) things.replaceChildren(...buttons);
  }
  function drawStatus() {
    const { objects } = documentNow();
    const object = objects[chosen ?? -1];
    if (!object) return setText(status, "");
    if (!object.xyz) return setText(status, t("scene.state.unplaced"));
    const limb = reachNow()?.at(object.xyz[0], object.xyz[1]);
    const reach =
      limb === undefined
        ? t("scene.state.unknown")
        : t(limb === null ? "scene.state.out" : "scene.state.in", { limb: limb ?? "" });
    const near = nearest(objects, chosen);
    const mm = Math.round((near?.gap ?? 0) * 1e3);
    const other = objects[near?.other ?? -1]?.name ?? "";
    const gap = near ? t(mm === 0 ? "scene.state.over" : "scene.state.gap", { mm, name: other }) : "";
    const words = findings.words[chosen ?? -1];
    const said = words ? t("scene.state.words", { words }) : "";
    setText(status, [reach, gap, said].filter(Boolean).join(" · "));
  }
  function drawFiles() {
    const names = [...listed.names];
    const here = draft?.name ?? "";
    const options = names.map((one) => {
      const text = one === listed.in_force ? t("scene.in_force", { name: one }) : one;
      return h("option", { value: one, text });
    });
    if (draft && draft.name === null) {
      options.unshift(h("option", { value: "", text: t("scene.unsaved") }));
    }
    const has = [...select.options].map(({ text }) => text).join();
    if (has !== options.map(({ text }) => text).join()) select.replaceChildren(...options);
    select.value = here;
    const n = findings.problems.length;
    setText(save, n > 0 ? t("scene.save_wrong", { n }) : t("scene.save"));
    setText(use, t("scene.use"));
    const isOther = name.value.trim() !== here;
    save.disabled = !canEdit() || Boolean(listed.locked) || !(draft?.isChanged || isOther);
    const isInForce = draft?.hash === listed.in_force_hash;
    use.disabled =
      !canEdit() || Boolean(listed.locked) || Boolean(draft?.isChanged) || isInForce || n > 0;
    for (const [node, is] of [
      [undo, draft?.canUndo],
      [redo, draft?.canRedo],
    ])
      node.disabled = !canEdit() || !is;
    for (const node of [add, copy, drop]) node.disabled = !canEdit();
    copy.disabled ||= chosen === null;
    drop.disabled ||= chosen === null;
  }
  const drawAll = () => {
    if (!dialog.open) return;
    drawFiles();
    setAttribute(dialog, "data-busy", isBusy);
    setAttribute(dialog, "data-locked", !canEdit() && !isBusy);
    for (const tab of tabs) {
      setAttribute(tab, "aria-pressed", String(tab.dataset.panel === panel));
    }
    if (!draft) return;
    const concerned = findings.problems.map(about).filter(({ kind }) => kind === "object");
    const wrong = new Set(concerned.map(({ n }) => n));
    const reach = reachNow();
    top.draw({ document: draft.document, robot, chosen, reach, wrong, canEdit: canEdit() });
    drawList(wrong);
    drawForm();
    body.toggleAttribute("inert", !canEdit());
    drawStatus();
    problems.draw(/** @type {any} */ (findings), canEdit());
    if (!canEdit() && !isBusy) setText(note, t("scene.look_only"));
    else if (listed.locked) setText(note, listed.locked);
    else if (note.textContent === t("scene.look_only")) setText(note, "");
  };
  const draw = Object.assign(eachFrame(drawAll), { now: drawAll });
  store.subscribe(["control", "welcome"], () => {
    if (dialog.open) rest();
    draw();
  });

  async function begin() {
    await attempt(async () => {
      listed = await api.list();
      if (draft) return;
      const kept = keptDraft();
      const first = listed.names.includes(listed.in_force) ? listed.in_force : listed.names[0];
      const which = kept ? kept.name : (first ?? null);
      take(which === null ? await api.create() : await api.open(which));
      // A file that has changed since is refused when it is saved.
      if (kept && draft) {
        Object.assign(draft, { text: kept.text, hash: kept.hash, saved: kept.saved });
        draft.document = kept.document;
        notify(t("scene.restored"));
      }
    });
  }
  return () => {
    if (dialog.open) return;
    dialog.showModal();
    store.set("cover", dialog);
    dialog.focus();
    begin();
  };
}

/** Loads the style of the editor; without it, it works, too. */
function loadStyle() {
  const href = new URL("../../css/scene.css", import.meta.url).href;
  return new Promise((resolve) => {
    document.head.append(h("link", { rel: "stylesheet", href, onload: resolve, onerror: resolve }));
  });
}
