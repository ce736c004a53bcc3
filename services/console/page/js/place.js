// @ts-check
/** The folder that the page is served from: the host's root, or a robot's folder behind a gateway. */
const PLACE = new URL("../", import.meta.url);

/** The page's place on its host: "/" or "/robot/". */
export const place = PLACE.pathname;

/**
 * The address of a path on the server.
 * @param {string} path from the server's root, e.g. `/api/state`
 */
export const addressOf = (path) => new URL(path.replace(/^\/+/, ""), PLACE).href;
