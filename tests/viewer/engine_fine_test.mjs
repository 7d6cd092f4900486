// The finest voxels that docs/viewer.md names fit a page's memory as it says, and answer as the command does.

import assert from 'node:assert/strict';
import {mkdtempSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import path from 'node:path';
import {after, test} from 'node:test';

import {answerOf, ist, linesOf} from './command.mjs';
import {startEngine} from './engine.mjs';

const folder = mkdtempSync(path.join(tmpdir(), 'ist-page-'));
after(() => rmSync(folder, {recursive: true}));

test('two jaws at 0.2 mm take 0.3 GB', async () => {
  const finest = 0.2,
    mostBytes = 0.35e9;
  ist(folder, 'demo', '--voxel-size', '2', '--keep', '.');
  const engine = await startEngine(process.env.IST_ENGINE);
  engine.ask('make_jaws', {seed: 1});
  const {moving} = engine.ask('build', {voxel_size: finest});
  const {in_use: held} = engine.ask('memory', {});
  console.log(`${moving.leaves} leaves; the engine holds ${(held / 1e6).toFixed(0)} MB of ${(engine.bytes() / 1e6).toFixed(0)} MB`);
  assert.ok(held > moving.bytes && held < engine.bytes(), `${held} of ${engine.bytes()} bytes`);
  const [, line] = linesOf(
    ist(folder, 'collide', 'upper_jaw.stl', 'lower_jaw.stl', '--voxel-size', `${finest}`, '--move', '0,0,-0.6', '--json'),
  );
  const answer = engine.ask('collide', {pose: line.pose});
  assert.deepEqual(answerOf(answer.line), answerOf(line));
  // Where it is built again, the trees before are still there.
  engine.ask('build', {voxel_size: finest});
  assert.deepEqual(answerOf(engine.ask('collide', {pose: line.pose}).line), answerOf(line));
  assert.ok(engine.bytes() < mostBytes, `${engine.bytes()} bytes`);
});
