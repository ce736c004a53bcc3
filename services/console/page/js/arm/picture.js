// @ts-check
/**
 * The page's end of the picture: it sends what is to be shown and queries what is shown, by messages,
 * to the worker or to the page itself. Notifications of the picture go to `heard`.
 */
export class Picture {
  #port;
  /** @type {Map<number, {resolve: (value: any) => void, reject: (error: Error) => void}>} */
  #asked = new Map();
  #last = 0;

  /** @param {MessagePort} port @param {(message: any) => void} heard */
  constructor(port, heard) {
    this.#port = port;
    port.onmessage = ({ data }) => (data.id === undefined ? heard(data) : this.#answered(data));
  }

  /** Calls a method of the view without a result. @param {string} what @param {any[]} args */
  call(what, ...args) {
    this.#port.postMessage({ what, args });
  }

  /**
   * Calls a method of the view and waits for its result.
   * @param {string} what
   * @param {any[]} args
   * @returns {Promise<any>}
   */
  ask(what, ...args) {
    const id = ++this.#last;
    this.#port.postMessage({ id, what, args });
    return new Promise((resolve, reject) => this.#asked.set(id, { resolve, reject }));
  }

  #answered({ id, value, error }) {
    const asked = this.#asked.get(id);
    this.#asked.delete(id);
    if (error === undefined) asked?.resolve(value);
    else asked?.reject(new Error(error));
  }
}

/**
 * Has the picture be drawn: in a worker, or else by the page itself.
 * @param {{canvas: HTMLCanvasElement}} parts its canvas is another afterwards if a worker had the
 *   first one and could not draw: a canvas can be given away once
 * @param {(message: any) => void} heard
 * @returns {Promise<Picture|null>} null without WebGL
 */
export async function openPicture(parts, heard) {
  for (const begin of [inWorker, onPage]) {
    const port = await begin(parts.canvas);
    if (port) return new Picture(port, heard);
    const canvas = /** @type {HTMLCanvasElement} */ (parts.canvas.cloneNode());
    parts.canvas.replaceWith(canvas);
    parts.canvas = canvas;
  }
  return null;
}

async function inWorker(canvas) {
  if (!("transferControlToOffscreen" in canvas)) return null;
  const worker = new Worker(new URL("./worker.js", import.meta.url), { type: "module" });
  const { port1, port2 } = new MessageChannel();
  const offscreen = canvas.transferControlToOffscreen();
  worker.postMessage({ canvas: offscreen, port: port2 }, [offscreen, port2]);
  // A browser that knows no modules in workers says no more than that there was an error.
  const failed = new Promise((resolve) => {
    worker.onerror = () => resolve(false);
  });
  if (await Promise.race([hasBegun(port1), failed])) return port1;
  worker.terminate();
  return null;
}

async function onPage(canvas) {
  const { perform } = await import("./perform.js");
  const { port1, port2 } = new MessageChannel();
  const begun = hasBegun(port1);
  perform(canvas, port2);
  return (await begun) ? port1 : null;
}

/** Waits for the first message, which says whether the picture can be drawn. */
function hasBegun(port) {
  return new Promise((resolve) => {
    port.onmessage = ({ data: { begun, error } }) => {
      if (error) console.warn(`the arm's picture: ${error}`);
      resolve(begun);
    };
  });
}
