// @ts-check
/** Turn of one press of an arrow key, radians. */
const TURN_RAD = 0.12;
const ZOOM = 1.12;
/** The action of each key on the camera: a method of the view, and its arguments. */
const KEYS = {
  ArrowLeft: ["turn", -TURN_RAD, 0],
  ArrowRight: ["turn", TURN_RAD, 0],
  ArrowUp: ["turn", 0, -TURN_RAD],
  ArrowDown: ["turn", 0, TURN_RAD],
  "+": ["zoom", 1 / ZOOM],
  "=": ["zoom", 1 / ZOOM],
  "-": ["zoom", ZOOM],
};
/** The fields of an event that the camera's controls read. */
const READ = [
  ..."pointerId pointerType button clientX clientY pageX pageY".split(" "),
  ..."deltaX deltaY deltaMode ctrlKey metaKey shiftKey key".split(" "),
];

/**
 * Sends a person's input to the picture.
 * @param {HTMLElement} stage takes the keys
 * @param {HTMLCanvasElement} canvas
 * @param {(what: string, ...args: any[]) => void} notify
 */
export function forwardInput(stage, canvas, notify) {
  const forward = (event) => {
    const fields = READ.flatMap((name) => (name in event ? [[name, event[name]]] : []));
    notify("happen", event.type, Object.fromEntries(fields));
  };
  forwardPointers(canvas, forward);
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener(
    "wheel",
    (event) => {
      // The wheel scrolls the page until the picture was chosen.
      if (!stage.contains(document.activeElement)) return;
      event.preventDefault();
      forward(event);
    },
    { passive: false },
  );
  stage.addEventListener("keydown", (event) => pressed(event, notify));
  // Browsers report a pinch on a touchpad as a wheel event with Control, without a key press.
  for (const type of /** @type {const} */ (["keydown", "keyup"])) {
    const listen = (event) => event.key === "Control" && forward(event);
    document.addEventListener(type, listen, { passive: true, capture: true });
  }
}

function forwardPointers(canvas, forward) {
  const down = new Set();
  // A finger that moves up and down scrolls the page; to the side it turns the picture.
  canvas.style.setProperty("touch-action", "pan-y");
  canvas.addEventListener("pointerdown", (event) => {
    down.add(event.pointerId);
    canvas.setPointerCapture(event.pointerId);
    forward(event);
  });
  canvas.addEventListener("pointermove", (event) => down.has(event.pointerId) && forward(event));
  for (const type of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(type, (event) => down.delete(event.pointerId) && forward(event));
  }
}

function pressed(event, notify) {
  const [what, ...args] = KEYS[event.key] ?? [];
  if (event.ctrlKey || event.metaKey || event.altKey || !what) return;
  event.preventDefault();
  event.stopPropagation();
  notify(what, ...args);
}
