// The ist command, and what it prints.
//
//   IST_COMMAND  the ist command of the same sources as the page
//   IST_PAGE     the page that it writes into, where it writes one

import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import path from 'node:path';

/** Runs the command in a folder, and gives what it prints. */
export function ist(folder, ...words) {
  const {IST_PAGE} = process.env,
    page = IST_PAGE ? {IST_PAGE: path.resolve(IST_PAGE)} : {};
  return execFileSync(process.env.IST_COMMAND, words, {
    cwd: folder,
    env: {...process.env, ...page},
    encoding: 'utf8',
    stdio: ['ignore', 'pipe', 'pipe'],
    maxBuffer: 1 << 28,
  });
}

export function linesOf(text) {
  return text
    .trimEnd()
    .split('\n')
    .map((line) => JSON.parse(line));
}

/** An answer without the keys that are a machine's. */
export function answerOf({target, microseconds_min, microseconds_median, ...answer}) {
  assert.equal(typeof target, 'string');
  assert.ok(microseconds_min >= 0 && microseconds_median >= 0);
  return answer;
}
