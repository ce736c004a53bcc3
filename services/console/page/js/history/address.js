// @ts-check
/**
 * The interaction that an address names: `#history=12`; 0: only the history; null: none.
 * @param {string} hash
 */
export function linked(hash) {
  const found = /^#history(?:=(\d{1,15}))?$/.exec(hash);
  return found ? Number(found[1] ?? 0) : null;
}

/** The address of an interaction. @param {number} interaction */
export const linkTo = (interaction) => (interaction ? `#history=${interaction}` : "#history");
