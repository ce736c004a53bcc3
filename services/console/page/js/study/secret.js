// @ts-check
const KEY = "whichone.study";

/**
 * The secret by which the server knows the participant's page: 32 hexadecimal digits that survive a
 * reload and are shared with no one else.
 */
export class Secret {
  /** @param {Storage|null} storage null: not kept */
  constructor(storage) {
    this.storage = storage;
    const kept = quietly(() => storage?.getItem(KEY));
    this.value = kept && /^[0-9a-f]{32}$/.test(kept) ? kept : this.renew();
  }

  /** For the next participant on this device. */
  renew() {
    const bytes = crypto.getRandomValues(new Uint8Array(16));
    this.value = [...bytes].map((byte) => byte.toString(16).padStart(2, "0")).join("");
    quietly(() => this.storage?.setItem(KEY, this.value));
    return this.value;
  }
}

/** Storage is refused in some private windows; the page works without. */
function quietly(f) {
  try {
    return f();
  } catch {
    return null;
  }
}
