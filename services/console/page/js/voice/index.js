// @ts-check
import { eachFrame } from "../dom.js";
import { keep, kept } from "./choices.js";
import { bindPress } from "./keys.js";
import { playback as makePlayback } from "./playback.js";
import { recognitionOf } from "./recognition.js";
import { sign } from "./sign.js";
import { Talk } from "./talk.js";
import { build, show } from "./view.js";

export { playback, REPLY } from "./playback.js";

/**
 * Voice both ways: a button to talk with, and the robot's voice.
 * @param {HTMLElement} element
 * @param {{link: any, store: any, t: any, settings: any}} context
 * @returns {{talk: Talk, playback: ReturnType<typeof makePlayback>}}
 */
export function mountVoice(element, { link, store, t, settings }) {
  const storage = stored();
  let draw = () => {};
  const notify = () => draw();
  const playback = makePlayback({ link, store, storage, notify });
  const talk = new Talk({ link, store, playback, choices: kept(storage), notify });
  const view = build(element, {
    t,
    settings,
    hasBrowser: recognitionOf() !== null,
    choices: talk.choices,
    choose: (change) => {
      talk.choose(change);
      keep(storage, talk.choices);
    },
    toggle: (what) => {
      if (what === "handsFree") talk.setHandsFree(!talk.handsFree);
      else if (what === "sound") playback.mute(!playback.muted);
      else if (what === "close") talk.close();
      else playback.unlock();
    },
  });
  bindPress(view.talk, (event) => talk.press(event));
  const drawNow = () => {
    const { talks, latched, handsFree, isOpening, isOpen } = talk;
    const { is, turn } = store.get("now");
    const standing = talk.standing();
    const known = { is, turn, talks, latched, handsFree, isOpening, isOpen, standing };
    show(view, { sign: sign(known), talk, playback, t });
  };
  draw = eachFrame(drawNow);
  store.subscribe(["now", "hearing", "welcome"], notify);
  // A hidden page does not listen.
  addEventListener("pagehide", () => talk.close());
  // At once: no button is without its words for as long as a frame.
  drawNow();
  return { talk, playback };
}

/** @returns {Storage|null} */
function stored() {
  try {
    return localStorage;
  } catch {
    return null;
  }
}
