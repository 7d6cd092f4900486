/**
 * The Worker's script: it starts the engine and answers the page's questions, one after the other.
 * The engine's own script, which defines createEngine(), is bundled in front of it. Nothing is ever
 * fetched: the page sends the engine's bytes first.
 */

/** @typedef {import('./protocol.js').ToWorker} ToWorker */

/**
 * @typedef {object} Engine
 * @property {{buffer: ArrayBuffer}} HEAPU8
 * @property {{writeFile(path: string, bytes: Uint8Array, how: {canOwn: boolean}): void, unlink(path: string): void}} FS
 * @property {(name: string, result: 'string', kinds: string[], values: string[]) => string} ccall
 * @property {(stage: string, part: number) => void} progress
 */

/** @type {Record<string, any>} */
const arrayKinds = {Float32Array, Float64Array, Uint32Array, Uint8Array};
// Milliseconds between two messages of progress: nobody sees more.
const leastBetween = 50;

const fullText = "the page's memory is full: take larger voxels or a coarser mesh, or use the command";

/** @type {Engine | undefined} */
let engine;

/**
 * Copies the arrays that an answer names out of the engine's memory.
 * @param {any} value
 * @param {ArrayBuffer[]} moved  takes the copies, which go to the page
 * @returns {any}
 */
function withArrays(value, moved) {
  if (value === null || typeof value !== 'object') return value;
  if (Array.isArray(value)) return value.map((each) => withArrays(each, moved));
  if (value.array) {
    const [kind, address, count] = value.array;
    const View = arrayKinds[kind];
    const copy = new View(/** @type {Engine} */ (engine).HEAPU8.buffer, address, count).slice();
    moved.push(copy.buffer);
    return copy;
  }
  return Object.fromEntries(Object.entries(value).map(([name, member]) => [name, withArrays(member, moved)]));
}

/** @param {ArrayBuffer} bytes */
async function start(bytes) {
  // @ts-ignore defined by the script in front of this one
  engine = /** @type {Engine} */ (await createEngine({wasmBinary: new Uint8Array(bytes)}));
  const {version, target} = JSON.parse(engine.ccall('ist_page_start', 'string', [], []));
  postMessage({ready: true, version, target});
}

/**
 * The file of a question, written to where the engine reads it.
 * @param {any} asked
 */
function fileOf(asked) {
  const name = asked.name.replace(/[/\\\0-\x1f\x7f]/g, '_').replace(/^\.{0,2}$/, 'mesh');
  return {name, path: `${asked.role === 'fixed' ? 'fixed' : 'moving'}/${name}`};
}

/**
 * @param {unknown} error
 * @returns {boolean} whether the browser gave no memory
 */
function isShortOfMemory(error) {
  return error instanceof RangeError ? /alloc|length/i.test(error.message) : /out of memory|OOM/i.test(String(error));
}

/** @param {ToWorker} message */
function answer({id, question, asked}) {
  const running = /** @type {Engine} */ (engine);
  const begun = performance.now();
  let sentAt = begun;
  running.progress = (stage, part) => {
    const now = performance.now();
    if (now - sentAt < leastBetween) return;
    sentAt = now;
    postMessage({id, progress: {stage, part}});
  };
  /** @type {any} */
  let sent = asked;
  let path = '';
  // The engine names the file by its path, and people know it by its name.
  const asNamed = (/** @type {string} */ text) => (path ? text.split(path).join(/** @type {any} */ (asked).name) : text);
  try {
    if (question === 'open') {
      const file = fileOf(asked);
      path = file.path;
      running.FS.writeFile(path, new Uint8Array(/** @type {any} */ (asked).bytes), {canOwn: true});
      sent = {...asked, name: file.name, bytes: undefined};
    }
    const text = running.ccall('ist_page_answer', 'string', ['string', 'string'], [question, JSON.stringify(sent)]);
    const reply = JSON.parse(text);
    /** @type {ArrayBuffer[]} */
    const moved = [];
    const message = reply.error
      ? {id, error: {code: reply.error.code, text: asNamed(reply.error.text)}}
      : {id, answer: withArrays(reply.answer, moved), milliseconds: performance.now() - begun, heap: running.HEAPU8.buffer.byteLength};
    postMessage(message, {transfer: moved});
  } catch (error) {
    // The engine itself ended: only a new one can go on.
    const text = isShortOfMemory(error) ? fullText : `the engine ended: ${error}`;
    postMessage({id, error: {code: 'engine-ended', text: asNamed(text)}});
  } finally {
    if (path) running.FS.unlink(path);
  }
}

self.onmessage = ({data}) => {
  if (data.start) {
    start(data.start).catch((error) => {
      postMessage({id: 0, error: {code: 'engine-missing', text: `the engine does not start: ${error}`}});
    });
    return;
  }
  answer(data);
};
