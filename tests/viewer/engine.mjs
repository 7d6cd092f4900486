// The page's engine in node, asked as page/worker.js asks it.

import {createRequire} from 'node:module';
import {readFileSync} from 'node:fs';
import path from 'node:path';

const arrayKinds = {Float32Array, Float64Array, Uint32Array, Uint8Array};

/** Starts the engine in the folder that scripts/viewer.sh builds it in. */
export async function startEngine(folder) {
  const createEngine = createRequire(import.meta.url)(path.resolve(folder, 'engine.js'));
  const engine = await createEngine({wasmBinary: readFileSync(path.join(folder, 'engine.wasm'))});
  const stages = new Set();
  engine.progress = (stage) => stages.add(stage);
  const about = JSON.parse(engine.ccall('ist_page_start', 'string', [], []));

  function withArrays(value) {
    if (value === null || typeof value !== 'object') return value;
    if (Array.isArray(value)) return value.map(withArrays);
    if (value.array) {
      const [kind, address, count] = value.array;
      return new arrayKinds[kind](engine.HEAPU8.buffer, address, count).slice();
    }
    return Object.fromEntries(Object.entries(value).map(([name, each]) => [name, withArrays(each)]));
  }

  /** Answers a question, or throws its error with its code. */
  function ask(question, asked) {
    const text = engine.ccall('ist_page_answer', 'string', ['string', 'string'], [question, JSON.stringify(asked)]);
    const reply = JSON.parse(text);
    if (reply.error) throw Object.assign(new Error(reply.error.text), {code: reply.error.code});
    return withArrays(reply.answer);
  }

  /** Opens a file of this machine, or bytes, for a role. */
  function open(role, name, bytes, more = {}) {
    engine.FS.writeFile(`${role}/${name}`, bytes);
    try {
      return ask('open', {role, name, ...more});
    } finally {
      engine.FS.unlink(`${role}/${name}`);
    }
  }
  return {ask, open, about, stages, bytes: () => engine.HEAPU8.buffer.byteLength};
}
