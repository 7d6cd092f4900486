/** Reads a recording while the page goes on drawing, with a bar and a button that ends it. */

import {EngineError} from '../engine/engine_client.js';
import {recordingSteps} from './recording.js';

/** @typedef {import('./recording.js').Recording} Recording */
/** @typedef {(text: string | Blob, name: string) => Promise<Recording>} ReadRecording  rejects with the code `cancelled` where the button was pressed */

// A browser's texts end at 512 MiB.
const mostBytes = 500e6;
// Milliseconds between two frames.
const patience = 30;

/**
 * @param {(onCancel: () => void) => import('../ui/progress.js').Progress} makeBar
 * @returns {ReadRecording}
 */
export function makeReadRecording(makeBar) {
  /** @type {object | null} */
  let reading = null;
  const bar = makeBar(() => {
    reading = null;
  });
  return async (from, name) => {
    const mine = (reading = {});
    const goOn = () => {
      if (reading !== mine) throw new EngineError('cancelled', 'cancelled');
    };
    bar.begin(`Reading ${name}`, true);
    try {
      const text = await textOf(from);
      goOn();
      const steps = recordingSteps(text);
      let drawn = performance.now();
      for (;;) {
        const {done, value} = steps.next();
        if (done) return value;
        if (performance.now() - drawn < patience) continue;
        bar.advance('', value);
        await new Promise((resolve) => {
          setTimeout(resolve);
        });
        goOn();
        drawn = performance.now();
      }
    } finally {
      // Another may be read by now, whose bar it is then.
      if (reading === mine || reading === null) bar.end();
    }
  };
}

/**
 * @param {string | Blob} from
 * @returns {Promise<string>}
 */
async function textOf(from) {
  if (typeof from === 'string') return from;
  if (from.size > mostBytes) {
    throw new Error(
      `It has ${Math.round(from.size / 1e6)} MB, and ${mostBytes / 1e6} MB are the most that a page reads: record fewer --seconds.`,
    );
  }
  try {
    return await from.text();
  } catch {
    throw new Error('The browser cannot read it. It may have changed since you chose it, or memory is short: choose it again.');
  }
}
