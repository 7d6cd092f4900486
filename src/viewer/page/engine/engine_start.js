/** Starts the engine: a Worker from the texts that the page holds. Nothing is fetched. */

import {fromBase64} from '../data_block.js';

/**
 * @typedef {object} EngineTexts
 * @property {Blob} script    of the Worker
 * @property {ArrayBuffer} bytes  of the engine
 */

/**
 * Unpacks what bundle.mjs put into the page.
 * @returns {Promise<EngineTexts>}
 */
export async function unpackEngine() {
  const [script, bytes] = await Promise.all(['ist-worker', 'ist-engine'].map(unpacked));
  return {script: new Blob([script], {type: 'text/javascript'}), bytes};
}

/**
 * @param {EngineTexts} texts
 * @returns {Worker} it answers {ready: true} once, when the engine runs
 */
export function startEngine({script, bytes}) {
  const address = URL.createObjectURL(script);
  const worker = new Worker(address);
  URL.revokeObjectURL(address);
  worker.postMessage({start: bytes});
  return worker;
}

/**
 * @param {string} id  of an element whose text is base64 of gzip
 * @returns {Promise<ArrayBuffer>}
 */
async function unpacked(id) {
  const text = document.getElementById(id)?.textContent?.trim();
  if (!text) throw new Error(`This page has no ${id}: it was not built whole. Get the file again, or build it with scripts/viewer.sh.`);
  const packed = new Blob([fromBase64(text)]).stream();
  return new Response(packed.pipeThrough(new DecompressionStream('gzip'))).arrayBuffer();
}
