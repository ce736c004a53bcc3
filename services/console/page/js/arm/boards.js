// @ts-check
/** Objects whose feet differ by less stand equally high, metres. */
const LEVEL_M = 0.015;
/** Distance up to which objects share a board. */
const CLOSE_M = 0.3;
/** Margin of a board around the objects on it. */
const RIM_M = 0.05;

/**
 * @typedef {object} Board
 * @property {[number, number]} low least x and y, metres in frame `base`
 * @property {[number, number]} high greatest x and y
 * @property {number} top height of its upper side
 */

/**
 * Boards under the objects: one per group of objects that stand at the same height and close
 * together.
 * @param {{xyz: number[], size: number[], yaw: number}[]} places of the objects
 * @returns {Board[]}
 */
export function boardsUnder(places) {
  const boards = places.map(under);
  for (;;) {
    const [i, j] = nearest(boards);
    if (i < 0) return boards;
    const [other] = boards.splice(j, 1);
    const board = boards[i];
    for (const k of [0, 1]) {
      board.low[k] = Math.min(board.low[k], other.low[k]);
      board.high[k] = Math.max(board.high[k], other.high[k]);
    }
    board.top = Math.min(board.top, other.top);
  }
}

/** Two boards that are one, or -1. */
function nearest(boards) {
  for (let j = 1; j < boards.length; j++) {
    for (let i = 0; i < j; i++) if (isOne(boards[i], boards[j])) return [i, j];
  }
  return [-1, -1];
}

function isOne(a, b) {
  const apart = (k) => Math.max(a.low[k] - b.high[k], b.low[k] - a.high[k]);
  return Math.abs(a.top - b.top) < LEVEL_M && apart(0) < CLOSE_M && apart(1) < CLOSE_M;
}

/** @returns {Board} */
function under({ xyz: [x, y, z], size: [wide, deep, tall], yaw }) {
  const [sin, cos] = [Math.abs(Math.sin(yaw)), Math.abs(Math.cos(yaw))];
  const half = [wide * cos + deep * sin, wide * sin + deep * cos].map((side) => side / 2 + RIM_M);
  return {
    low: [x - half[0], y - half[1]],
    high: [x + half[0], y + half[1]],
    top: z - tall / 2,
  };
}

/** Distance from the farthest board to an object handed over, metres. */
const REACH_M = 0.3;
const APART_M = 0.06;

/**
 * Places of the objects that a person has taken: side by side on the person's side of the table.
 * @param {{xyz: number[], size: number[]}[]} places of all objects
 * @param {number[]} taken which of them, in the order in which they are to stand
 * @returns {Map<number, [number, number, number]>} their centres, by object
 */
export function personsPlaces(places, taken) {
  const far = Math.max(...places.map(({ xyz, size }) => xyz[0] + size[0] / 2), 0.6) + REACH_M;
  const table = tableTop(places);
  const widths = taken.map((n) => Math.max(places[n].size[0], places[n].size[1]) + APART_M);
  let y = -widths.reduce((sum, wide) => sum + wide, 0) / 2;
  return new Map(
    taken.map((n, k) => {
      const centre = y + widths[k] / 2;
      y += widths[k];
      return [n, [far, centre, table + places[n].size[2] / 2]];
    }),
  );
}

/** Height of the table: of the board under the object nearest to the middle, metres. */
export function tableTop(places) {
  if (places.length === 0) return 0;
  const middle = places.reduce((a, b) => (Math.abs(b.xyz[1]) < Math.abs(a.xyz[1]) ? b : a));
  return middle.xyz[2] - middle.size[2] / 2;
}
