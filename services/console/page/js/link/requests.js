// @ts-check
/** Reason why a request to the server failed. */
export class LinkError extends Error {
  /**
   * @param {"down"|"late"|"lost"|"refused"} code `down`: not sent; `late`: no answer in time;
   *   `lost`: the connection broke before the answer; `refused`: the server says why
   * @param {string} message the server's sentence, or one in English
   */
  constructor(code, message) {
    super(message);
    this.name = "LinkError";
    this.code = code;
  }
}

/** Requests to the server that have not been answered yet. */
export class Requests {
  #next = 1;
  /** @type {Map<number, {settle: (error: LinkError|null, done?: object) => void}>} */
  #open = new Map();

  /**
   * Opens a request.
   * @param {number} deadlineMs how long its answer is waited for
   * @returns {{id: number, answer: Promise<any>}}
   */
  open(deadlineMs) {
    const id = this.#next++;
    const answer = new Promise((resolve, reject) => {
      const late = () =>
        this.#settle(id, new LinkError("late", "The robot did not answer in time."));
      const timer = setTimeout(late, deadlineMs);
      const settle = (error, done) => {
        clearTimeout(timer);
        if (error) reject(error);
        else resolve(done);
      };
      this.#open.set(id, { settle });
    });
    return { id, answer };
  }

  /**
   * Takes in a `done` of the server. One without a waiting request is ignored.
   * @param {{id: number, ok: boolean, error?: string}} done
   */
  done(done) {
    const error = done.ok ? null : new LinkError("refused", done.error ?? "The robot refused.");
    this.#settle(done.id, error, done);
  }

  /** Ends every open request: the connection broke. */
  lose() {
    const lost = "The connection broke before the answer came.";
    for (const id of [...this.#open.keys()]) this.#settle(id, new LinkError("lost", lost));
  }

  /** Number of open requests. */
  get size() {
    return this.#open.size;
  }

  #settle(id, error, done) {
    const request = this.#open.get(id);
    if (!request) return;
    this.#open.delete(id);
    request.settle(error, done);
  }
}
