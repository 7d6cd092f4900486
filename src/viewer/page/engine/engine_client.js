/**
 * Asks the engine's Worker, one question at a time. A long question can be cancelled: the Worker is
 * ended, another is started, and the caller's `restore` gives it the bodies again. A lazy client
 * starts its Worker, and has it restored, when it is asked.
 */

/** @typedef {import('../protocol.js').Questions} Questions */
/** @typedef {import('../protocol.js').FromWorker} FromWorker */
/** @typedef {import('../ui/progress.js').Progress} Progress */

/**
 * @typedef {object} AskOptions
 * @property {boolean} [latest]  a question of this name that still waits is replaced by this one
 * @property {boolean} [first]   it is asked before all that wait
 * @property {string} [doing]    words for the progress bar, with a button to cancel
 * @property {boolean} [seldomLong]  the bar comes later, so that it does not flicker where this is asked often
 */
/**
 * @typedef {object} EngineClient
 * @property {<Name extends keyof Questions>(name: Name, asked: Questions[Name][0], options?: AskOptions) => Promise<Questions[Name][1]>} ask
 *   rejects with an EngineError
 * @property {() => void} cancel   ends what is asked now, and what waits of the same name; all else is asked after it
 * @property {(name?: string, code?: 'replaced' | 'cancelled') => void} drop  a lazy client's questions of that name end; without a name: all, and its Worker
 * @property {() => boolean} busy
 * @property {() => EngineFigures} figures
 */
/**
 * @typedef {object} EngineFigures
 * @property {string} version
 * @property {string} target     instruction set
 * @property {number | null} heap    bytes of the engine's memory
 * @property {number[]} tickTimes  milliseconds that the last ticks took the Worker, at most 10,000
 */
/**
 * @typedef {object} Waiting
 * @property {number} id
 * @property {string} name
 * @property {object} asked
 * @property {AskOptions} options
 * @property {(answer: any) => void} resolve
 * @property {(error: EngineError) => void} reject
 */

/** The engine's refusal, or why there is no answer: its code is then `replaced`, `cancelled` or `engine-ended`. */
export class EngineError extends Error {
  /**
   * @param {string} code
   * @param {string} text
   */
  constructor(code, text) {
    super(text);
    this.code = code;
  }
}

/**
 * @param {unknown} error
 * @returns {string | null} the sentence that people are to read; null where nothing went wrong
 */
export function faultText(error) {
  if (error instanceof EngineError && (error.code === 'replaced' || error.code === 'cancelled')) return null;
  const text = error instanceof Error ? error.message : String(error);
  const beginsWithFile = /^[^:]+\.\w+:/.test(text);
  return beginsWithFile ? text : text.charAt(0).toUpperCase() + text.slice(1);
}

const mostTimes = 10_000;

/**
 * @param {object} parts
 * @param {() => Worker} parts.start
 * @param {Progress} parts.progress
 * @param {(ask: EngineClient['ask']) => Promise<void>} parts.restore  gives a new engine what the old one had
 * @param {(error: unknown) => void} parts.onLost  the engine does not start, or cannot be restored
 * @param {boolean} [parts.lazy]
 * @returns {EngineClient}
 */
export function makeEngineClient({start, progress, restore, onLost, lazy = false}) {
  /** @type {Waiting[]} */
  let queue = [];
  /** @type {Waiting | null} */
  let running = null;
  let ready = false,
    restoring = false,
    lastId = 0,
    lives = 0;
  /** @type {EngineFigures} */
  const figures = {version: '', target: '', heap: null, tickTimes: []};
  /** @type {Worker | null} none: it is started when something is asked */
  let worker = null;
  if (!lazy) worker = listenTo(start());

  /** @param {Worker} to */
  function listenTo(to) {
    to.onmessage = ({data}) => to === worker && take(data);
    to.onerror = (event) => {
      event.preventDefault();
      if (to === worker) take({id: running?.id ?? 0, error: {code: 'engine-ended', text: `the engine ended: ${event.message}`}});
    };
    return to;
  }

  /** @param {FromWorker} message */
  function take(message) {
    if ('ready' in message) {
      ready = true;
      Object.assign(figures, {version: message.version, target: message.target});
      if (restoring) restoreNow();
      pump();
      return;
    }
    if ('error' in message && message.id === 0) {
      fail(new EngineError(message.error.code, message.error.text));
      return;
    }
    if (message.id !== running?.id) return;
    if ('progress' in message) {
      progress.advance(message.progress.stage, message.progress.part);
      return;
    }
    const {name, resolve, reject} = running;
    running = null;
    if ('heap' in message && typeof message.heap === 'number') figures.heap = message.heap;
    if ('error' in message) {
      if (message.error.code === 'engine-ended') restart();
      reject(new EngineError(message.error.code, message.error.text));
    } else {
      if (name === 'tick') figures.tickTimes = [...figures.tickTimes.slice(1 - mostTimes), message.milliseconds];
      resolve(message.answer);
    }
    pump();
  }

  function pump() {
    if (running || !ready || !worker) return;
    const at = queue.findIndex((each) => !restoring || each.options === byRestore);
    if (at < 0) {
      if (!restoring) progress.end();
      return;
    }
    [running] = queue.splice(at, 1);
    if (running.options.doing) progress.begin(running.options.doing, true, running.options.seldomLong);
    else if (!restoring) progress.end();
    const {id, name, asked} = running;
    const bytes = /** @type {{bytes?: unknown}} */ (asked).bytes;
    worker.postMessage({id, question: name, asked}, bytes instanceof ArrayBuffer ? [bytes] : []);
  }

  /** @type {EngineClient['ask']} */
  function ask(name, asked, options = {}) {
    if (options.latest) {
      const [replaced] = queue.filter((each) => each.name === name && each.options.latest);
      if (replaced) {
        queue = queue.filter((each) => each !== replaced);
        replaced.reject(new EngineError('replaced', 'a later question replaced this one'));
      }
    }
    return new Promise((resolve, reject) => {
      lastId += 1;
      const waiting = {id: lastId, name, asked, options, resolve, reject};
      if (options.first) queue.unshift(waiting);
      else queue.push(waiting);
      if (!worker) restart();
      pump();
    });
  }

  const byRestore = {};
  async function restoreNow() {
    const life = lives;
    try {
      // What a Worker that is gone was to get, no other gets.
      await restore((name, asked) => (life === lives ? ask(name, asked, byRestore) : new Promise(() => {})));
      if (life !== lives) return;
      restoring = false;
      pump();
    } catch (error) {
      if (life !== lives) return;
      restoring = false;
      onLost(error);
      pump();
    }
  }

  function restart() {
    worker?.terminate();
    ready = false;
    restoring = true;
    worker = listenTo(start());
    progress.begin(lazy ? 'Starting a second engine' : 'Starting the engine again', lazy);
  }

  /** Ends the Worker; another starts where something still waits, or else when it is asked. */
  function sleep() {
    worker?.terminate();
    worker = null;
    lives += 1;
    running = null;
    ready = restoring = false;
    queue = queue.filter((each) => each.options !== byRestore);
    if (queue.length > 0) restart();
    else progress.end();
  }

  /**
   * @param {(each: Waiting) => boolean} which
   * @param {string} code
   */
  function end(which, code) {
    const lost = [...(running ? [running] : []), ...queue].filter((each) => each.options !== byRestore && which(each));
    queue = queue.filter((each) => !lost.includes(each));
    if (running !== null && lost.includes(running)) {
      running = null;
      if (lazy) sleep();
      else restart();
    }
    for (const each of lost) each.reject(new EngineError(code, code));
  }

  /** @param {EngineError} error */
  function fail(error) {
    const lost = [...queue, ...(running ? [running] : [])];
    queue = [];
    running = null;
    for (const each of lost) each.reject(new EngineError('cancelled', error.message));
    progress.end();
    onLost(error);
  }

  return {
    ask,
    cancel() {
      const now = restoring && lazy ? queue.find((each) => each.options !== byRestore) : running;
      if (restoring && !lazy) return;
      if (now) end((each) => each.name === now.name, 'cancelled');
      if (restoring && lazy) sleep();
    },
    drop(name, code = 'replaced') {
      end((each) => name === undefined || each.name === name, code);
      if (name === undefined) sleep();
    },
    busy: () => running !== null || queue.length > 0 || restoring,
    figures: () => figures,
  };
}
