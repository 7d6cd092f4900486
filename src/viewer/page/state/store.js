/** The page's state, in one place. */

/** @typedef {import('../context.js').State} State */
/** @typedef {import('../context.js').Store} Store */

/**
 * @param {State} state
 * @returns {Store}
 */
export function makeStore(state) {
  /** @type {Set<{keys: (keyof State)[], told: (state: Readonly<State>) => void}>} */
  const listeners = new Set();
  return {
    get: () => state,
    set(change) {
      const changed = /** @type {(keyof State)[]} */ (Object.keys(change)).filter((key) => !Object.is(state[key], change[key]));
      if (changed.length === 0) return;
      state = {...state, ...change};
      for (const listener of [...listeners]) {
        if (listener.keys.some((key) => changed.includes(key))) listener.told(state);
      }
    },
    subscribe(keys, told) {
      const listener = {keys, told};
      listeners.add(listener);
      return () => listeners.delete(listener);
    },
  };
}
