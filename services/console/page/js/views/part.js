// @ts-check
import { h } from "../dom.js";

/**
 * Mounts a part of the page that is loaded separately. If that fails, its place says so, and the
 * rest of the page works.
 * @param {HTMLElement} element
 * @param {() => Promise<any>} load
 * @param {string} mount name of the function that the module exports
 * @param {{link: object, store: object, t: (key: string) => string}} context
 */
export async function mountPart(element, load, mount, context) {
  try {
    const part = await load();
    await part[mount](element, context);
  } catch (error) {
    console.warn(`${mount}: ${error}`);
    const key = `${element.id}.missing`;
    element.replaceChildren(h("p", { class: "missing", text: context.t(key) }));
  }
}
