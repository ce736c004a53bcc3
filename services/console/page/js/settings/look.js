// @ts-check
/**
 * How the page looks on this browser: each choice is an attribute `data-NAME` of the document's root, and
 * kept under its name; the first value of each is the default and is not kept. `early.js` reads the same
 * names before anything is painted.
 */
export const LOOK = {
  theme: ["auto", "light", "dark"],
  text: ["normal", "large", "larger"],
  motion: ["auto", "less"],
};

/**
 * The value in force.
 * @param {keyof typeof LOOK} name
 * @param {{dataset: DOMStringMap}} root
 */
export function chosen(name, root) {
  const value = root.dataset[name] ?? "";
  return LOOK[name].includes(value) ? value : LOOK[name][0];
}

/**
 * Puts a value in force and keeps it.
 * @param {keyof typeof LOOK} name
 * @param {string} value
 * @param {{dataset: DOMStringMap}} root
 * @param {(name: string, value: string|null) => void} keep
 */
export function choose(name, value, root, keep) {
  const isDefault = value === LOOK[name][0];
  if (isDefault) delete root.dataset[name];
  else root.dataset[name] = value;
  keep(name, isDefault ? null : value);
}
