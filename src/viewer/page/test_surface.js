/**
 * What a test reads of the page: `window.ist`, which changes nothing, and the state of the document:
 * `document.documentElement.dataset.state` is `busy` while an answer is missing or old, `ready` when
 * all are of the pose, `failed` when the engine does not start.
 *
 * @typedef {object} TestSurface
 * @property {() => Readonly<import('./context.js').State>} state
 * @property {() => {header: object, line: object} | null} answer  the lines of `ist collide --json`
 *   at the pose; null while it has not rested
 * @property {() => object | null} bite          the JSON of `ist occlusion` at the pose
 * @property {() => {count: number, p50: number, p99: number, max: number}} tickTimes  ms, by the Worker
 * @property {() => number | null} heap          bytes of the engine's memory, used or not
 * @property {() => Promise<number>} memory      bytes that the engine holds now
 * @property {() => {tick: number, last: number} | null} playback
 * @property {() => Promise<Blob>} picture  PNG of the canvas alone
 */

/** @typedef {import('./context.js').Store} Store */
/** @typedef {import('./engine/engine_client.js').EngineClient} EngineClient */

/**
 * @param {object} parts
 * @param {Store} parts.store
 * @param {EngineClient} parts.engine
 * @param {() => boolean} parts.busy
 * @param {() => boolean} parts.settled
 * @param {() => boolean} parts.opened   whether what the page came with is opened
 * @param {TestSurface['playback']} parts.playback
 * @param {TestSurface['picture']} parts.picture
 */
export function exposeTestSurface({store, engine, busy, settled, opened, playback, picture}) {
  /** @type {TestSurface} */
  const surface = {
    state: store.get,
    answer() {
      const {answer, pose} = store.get();
      return answer?.pose === pose ? {header: answer.header, line: answer.line} : null;
    },
    bite() {
      const {bite, pose} = store.get();
      return bite?.pose === pose ? bite.bite : null;
    },
    tickTimes() {
      const times = [...engine.figures().tickTimes].sort((a, b) => a - b);
      const at = (/** @type {number} */ part) => times[Math.min(times.length - 1, Math.floor(part * times.length))] ?? NaN;
      return {count: times.length, p50: at(0.5), p99: at(0.99), max: at(1)};
    },
    heap: () => engine.figures().heap,
    memory: async () => (await engine.ask('memory', {})).in_use,
    playback,
    picture,
  };
  Object.assign(window, {ist: Object.freeze(surface)});
  const {dataset} = document.documentElement;
  setInterval(() => {
    if (dataset.state !== 'failed') dataset.state = busy() || !settled() || !opened() ? 'busy' : 'ready';
  }, 50);
}
