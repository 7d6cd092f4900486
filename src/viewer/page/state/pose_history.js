/** Undo and redo of the pose. A drag is one step, from rest to rest. */

/** @typedef {import('../context.js').Store} Store */
/** @typedef {import('../protocol.js').Pose} Pose */

const most = 200;

/**
 * @typedef {object} PoseHistory
 * @property {() => void} undo
 * @property {() => void} redo
 * @property {() => boolean} canUndo
 * @property {() => boolean} canRedo
 * @property {() => void} forget  what was before: the bodies are others now
 */

/**
 * @param {Store} store
 * @returns {PoseHistory}
 */
export function makePoseHistory(store) {
  /** @type {Pose[]} */
  let undone = [];
  /** @type {Pose[]} */
  let done = [];
  let rest = store.get().pose;
  store.subscribe(['pose', 'dragging'], ({pose, dragging}) => {
    if (dragging || pose === rest || pose.every((value, at) => value === rest[at])) return;
    done = [...done, rest].slice(-most);
    undone = [];
    rest = pose;
  });
  /**
   * @param {Pose[]} from
   * @param {Pose[]} to
   */
  const step = (from, to) => {
    const pose = from.pop();
    if (!pose) return;
    to.push(rest);
    rest = pose;
    store.set({pose, dragging: false});
  };
  return {
    undo: () => step(done, undone),
    redo: () => step(undone, done),
    canUndo: () => done.length > 0,
    canRedo: () => undone.length > 0,
    forget: () => {
      [done, undone] = [[], []];
      rest = store.get().pose;
    },
  };
}
