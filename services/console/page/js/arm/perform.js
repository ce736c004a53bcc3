// @ts-check
import { Questions } from "./questions.js";
import { ArmView } from "./view.js";

/**
 * Draws the picture as messages say. Each names a method of `ArmView`, or of `Questions`; those with
 * an `id` are answered. Runs in a worker, or in the page itself if a worker cannot draw.
 * @param {HTMLCanvasElement|OffscreenCanvas} canvas
 * @param {MessagePort} port to `Picture`; hears first whether the picture can be drawn at all
 */
export function perform(canvas, port) {
  let view;
  try {
    view = new ArmView(canvas, (message) => port.postMessage(message));
  } catch (error) {
    port.postMessage({ begun: false, error: String(error) });
    return;
  }
  const questions = new Questions(view);
  port.onmessage = ({ data: { id, what, args } }) => {
    const actor = what in questions ? questions : view;
    if (id === undefined) actor[what](...args);
    else port.postMessage({ id, ...answer(() => actor[what](...args)) });
  };
  port.postMessage({ begun: true });
}

function answer(task) {
  try {
    return { value: task() };
  } catch (error) {
    return { error: error instanceof Error ? error.message : String(error) };
  }
}
