// @ts-check
/** Most lines that are kept: as many as the server does. */
export const LINES_MAX = 200;

/**
 * The transcript with further lines: in the order of their ids, the newer one of an id counts, and
 * of all the latest. Lines of another transcript (the group was restarted) replace it.
 * @template {{id: number, at_ms?: number}} L
 * @param {L[]} known oldest first
 * @param {L[]} more
 * @returns {L[]}
 */
export function mergeLines(known, more) {
  if (more.length === 0) return known;
  const last = known.at(-1)?.id ?? Number.NEGATIVE_INFINITY;
  const inOrder = more.every((line, i) => line.id > (i === 0 ? last : more[i - 1].id));
  if (isAnother(known, more)) return mergeLines([], more);
  if (inOrder) return [...known, ...more].slice(-LINES_MAX);
  const byId = new Map(known.map((line) => [line.id, line]));
  for (const line of more) byId.set(line.id, line);
  return [...byId.values()].sort((a, b) => a.id - b.id).slice(-LINES_MAX);
}

/** Returns whether known line numbers now belong to other lines. */
function isAnother(known, more) {
  const last = known.at(-1);
  if (!last) return false;
  const at = new Map(known.map((line) => [line.id, line.at_ms]));
  const latest = Math.max(...known.map((line) => line.at_ms ?? 0));
  return more.some(({ id, at_ms: time }) => {
    if (id > last.id || time === undefined) return false;
    return at.has(id) ? at.get(id) !== time : time > latest;
  });
}
