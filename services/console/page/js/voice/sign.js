// @ts-check
/**
 * @typedef {object} Known
 * @property {string} is the robot's state, of section `now`
 * @property {string|undefined} turn state of section `turn`
 * @property {boolean} talks
 * @property {boolean} latched
 * @property {boolean} handsFree
 * @property {boolean} isOpening
 * @property {boolean} isOpen
 * @property {string|null} standing reason why the person cannot talk
 */

/**
 * The talk button's text and looks, consistent with whose turn it is.
 * @param {Known} known
 * @returns {{key: string, state: "off"|"idle"|"opening"|"talking"|"hearing"|"understanding",
 *   disabled: boolean}} `key` of the words: `voice.talk.KEY`, with `voice.talk.KEY.more` below
 */
export function sign({ is, turn, talks, latched, handsFree, isOpening, isOpen, standing }) {
  if (is === "disconnected") return { key: "off", state: "off", disabled: true };
  if (is === "held") return { key: "held", state: "off", disabled: true };
  if (standing) return { key: "unable", state: "off", disabled: false };
  if (isOpening) return { key: "opening", state: "opening", disabled: false };
  const open = talks || (handsFree && isOpen);
  if (open && turn === "hearing") return { key: "hearing", state: "hearing", disabled: false };
  if (talks) return { key: latched ? "latched" : "talking", state: "talking", disabled: false };
  if (turn === "understanding") {
    return { key: "understanding", state: "understanding", disabled: false };
  }
  if (open) return { key: "open", state: "talking", disabled: false };
  return { key: "idle", state: "idle", disabled: false };
}
