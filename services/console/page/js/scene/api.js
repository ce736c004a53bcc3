// @ts-check
import { addressOf } from "../place.js";

/** A request that was refused, with every problem of the scene if that is the reason. */
export class Refused extends Error {
  /** @param {number} status @param {{error?: string, problems?: any[], details?: string[]}} answer */
  constructor(status, { error, problems, details }) {
    super([error ?? `status ${status}`, ...(details ?? [])].join("\n"));
    this.status = status;
    this.problems = problems ?? [];
  }
}

/**
 * The console's endpoints for scenes.
 * @param {string} session of this page
 */
export function scenesApi(session) {
  /**
   * @param {"GET"|"POST"|"PUT"} method
   * @param {string} path
   * @param {object} [body]
   * @param {AbortSignal} [signal]
   */
  async function ask(method, path, body, signal) {
    const headers = { "x-whichone-session": session, "content-type": "application/json" };
    const text = body === undefined ? null : JSON.stringify(body);
    const response = await fetch(addressOf(path), { method, headers, body: text, signal });
    const answer = await response.json().catch(() => ({}));
    if (!response.ok) throw new Refused(response.status, answer);
    return answer;
  }
  const file = (name) => `/api/scenes/${encodeURIComponent(name)}`;
  return {
    list: () => ask("GET", "/api/scenes"),
    open: (name) => ask("GET", file(name)),
    create: () => ask("GET", "/api/editor/new"),
    check: (draft, signal) => ask("POST", "/api/editor/check", draft, signal),
    reach: (object, at, signal) => ask("POST", "/api/editor/reach", { object, at }, signal),
    save: (name, saving) => ask("PUT", file(name), saving),
    use: (name) => ask("POST", `${file(name)}/use`),
  };
}
