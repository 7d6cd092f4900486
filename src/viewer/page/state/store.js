/** The page's state, in one place. */

/** @typedef {import('../context.js').State} State */
/** @typedef {import('../context.js').Store} Store */

/**
 * @param {State} state
 * @returns {Store}
 */
export function makeStore(state) {
  /** @type {Set<{keys: (keyof State)[], listen: (state: Readonly<State>) => void}>} */
  const listeners = new Set();
  return {
    get: () => state,
    set(change) {
      const changed = /** @type {(keyof State)[]} */ (Object.keys(change)).filter((key) => !Object.is(state[key], change[key]));
      if (changed.length === 0) return;
      state = {...state, ...change};
      for (const listener of [...listeners]) {
        if (listener.keys.some((key) => changed.includes(key))) listener.listen(state);
      }
    },
    subscribe(keys, listen) {
      const listener = {keys, listen};
      listeners.add(listener);
      return () => listeners.delete(listener);
    },
  };
}
