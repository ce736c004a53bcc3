// @ts-check
/**
 * Stands for the canvas' element towards OrbitControls, which are where the picture is drawn: there
 * the camera belongs to, and so a drag costs one message and no answer. The page sends what happens
 * to the element, and does itself what only the page can do: capturing pointers, and keeping the
 * browser from its own answer to the wheel.
 */
export class Pointed extends EventTarget {
  style = {};
  clientWidth = 1;
  clientHeight = 1;

  /** Keys and captured pointers, too, are heard here. */
  get ownerDocument() {
    return this;
  }

  setPointerCapture() {}
  releasePointerCapture() {}

  /** Has an event happen. @param {string} type @param {object} fields those that are read of it */
  happen(type, fields) {
    this.dispatchEvent(Object.assign(new Event(type), fields));
  }
}
