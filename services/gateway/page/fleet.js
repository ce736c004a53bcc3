// @ts-check
// The list of robots, looked at again and again; and the login page's remark on a wrong secret.

/** Between two looks, milliseconds. */
const LOOK_MS = 2_000;

/** @param {string} id */
const at = (id) => document.getElementById(id);

/** @type {any[]} */
let robots = [];
let shown = "";

/** Content of a robot's row: text, and tone if it matters. @param {any} listed */
function cells({ connected, presence, right }) {
  if (!connected)
    return [
      ["not connected", "warn"],
      ["", ""],
      ["", ""],
      ["", ""],
      ["", ""],
      ["", ""],
      [right, ""],
    ];
  if (!presence)
    return [
      ["silent", "warn"],
      ["", ""],
      ["", ""],
      ["", ""],
      ["", ""],
      ["", ""],
      [right, ""],
    ];
  const { state, line, likeliest, arm, stopped, scene, version } = presence;
  const share = likeliest ? `${likeliest[0]} ${Math.round(likeliest[1] * 100)} %` : "";
  return [
    [state || "unknown", state === "ready" ? "" : "warn"],
    [line, ""],
    [share, ""],
    stopped ? ["stopped", "stop"] : [arm, ""],
    [scene, ""],
    [version, ""],
    [right, ""],
  ];
}

/** @param {any} listed */
function row(listed) {
  const line = document.createElement("tr");
  line.dataset.robot = listed.robot;
  line.dataset.state = !listed.connected ? "away" : listed.presence ? "here" : "silent";
  const head = document.createElement("th");
  head.scope = "row";
  const link = document.createElement("a");
  link.href = `/${listed.robot}/`;
  link.textContent = listed.robot;
  head.append(link);
  line.append(head);
  for (const [text, tone] of cells(listed)) {
    const cell = line.insertCell();
    cell.textContent = text;
    if (tone) cell.dataset.tone = tone;
  }
  return line;
}

function show() {
  const wanted = /** @type {HTMLInputElement} */ (at("find")).value.trim().toLowerCase();
  const found = robots.filter((robot) => JSON.stringify(robot).toLowerCase().includes(wanted));
  const now = JSON.stringify(found);
  if (now === shown) return;
  shown = now;
  at("robots")?.replaceChildren(...found.map(row));
  const connected = robots.filter((robot) => robot.connected).length;
  const count = at("count");
  if (count) count.textContent = `${connected} connected`;
  const none = at("none");
  if (none) none.hidden = robots.length > 0;
}

async function look() {
  const lost = /** @type {HTMLElement} */ (at("lost"));
  try {
    const answer = await fetch("/_/robots", { cache: "no-store" });
    if (answer.status === 401) return location.assign("/_/login");
    if (!answer.ok) throw new Error(`${answer.status}`);
    const list = await answer.json();
    robots = list.robots;
    const person = at("person");
    if (person) person.textContent = list.person;
    lost.hidden = true;
    show();
  } catch {
    lost.hidden = false;
  }
  setTimeout(look, document.hidden ? 5 * LOOK_MS : LOOK_MS);
}

const wrong = at("wrong");
if (wrong) {
  wrong.hidden = !new URLSearchParams(location.search).has("wrong");
} else {
  at("find")?.addEventListener("input", show);
  look();
}
