// @ts-check
/**
 * The visible conversation: words, ends of requests, and stops. Presentations of one prompt that follow
 * each other are one item, with the fullest of their texts. Other notes are events.
 * @template {{who: string, text: string, said?: [number, number], outcome?: string}} L
 * @param {L[]} lines oldest first
 * @returns {{line: L, lines: L[]}[]} `line`: the one to show; `lines`: all that it represents
 */
export function conversation(lines) {
  /** @type {{line: L, lines: L[]}[]} */
  const items = [];
  for (const line of lines.filter((line) => !isEvent(line))) {
    const before = items.at(-1);
    if (before && line.said && line.said[0] === before.line.said?.[0]) {
      before.lines.push(line);
      if (line.text.length > before.line.text.length) before.line = line;
    } else {
      items.push({ line, lines: [line] });
    }
  }
  return items;
}

/**
 * The notes outside the conversation, newest first.
 * @template {{who: string, outcome?: string, unix_ms: number}} L
 * @param {L[]} lines
 * @param {L[]} own the page's own
 * @param {number} most
 */
export function events(lines, own, most) {
  const all = [...lines.filter(isEvent), ...own];
  return all.sort((a, b) => b.unix_ms - a.unix_ms).slice(0, most);
}

/** Notes that are part of the conversation: whoever reads it must know why nothing follows. */
const SAID = ["ended", "stopped", "released"];

/** @param {{who: string, outcome?: string, note?: {type: string}}} line */
function isEvent({ who, outcome, note }) {
  return who === "system" && outcome === undefined && !SAID.includes(note?.type ?? "");
}
