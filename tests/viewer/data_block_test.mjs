import assert from 'node:assert/strict';
import {test} from 'node:test';

import {fromBase64, readDataBlock} from '../../src/viewer/page/data_block.js';
import {identity} from '../../src/viewer/page/pose.js';

const toBase64 = (bytes) => Buffer.from(bytes).toString('base64');
const body = (role, more = {}) => ({role, name: `${role} </script>.stl`, tree: toBase64(new Uint8Array([1, 2, 3])), ...more});
const bite = {
  format: 1,
  made_by: 'ist 1.2.3',
  kind: 'bite',
  bodies: [body('fixed'), body('moving')],
  pose: [...identity],
  occlusion: {preset: 'scan', reach: 2},
};
const recording = {
  format: 1,
  made_by: 'ist 1.2.3',
  kind: 'recording',
  metres_per_unit: 0.001,
  recording: '{}',
  bodies: [body('fixed', {pose: [...identity]}), body('moving', {pose: [...identity], in_tool: [...identity], held: true, index: 1})],
};
const read = (block) => readDataBlock(JSON.stringify(block));

test('an empty block is no data, and no problem', () => {
  assert.deepEqual(readDataBlock('null'), {data: null, problem: null});
});

test('blocks of each kind are read', () => {
  assert.deepEqual(read(bite), {data: bite, problem: null});
  assert.deepEqual(read(recording), {data: recording, problem: null});
  assert.equal(read({format: 1, made_by: 'ist', kind: 'recording', recording: '{}', bodies: []}).problem, null);
  assert.equal(read({format: 1, made_by: 'ist', kind: 'bodies', bodies: [body('moving')]}).problem, null);
});

test('a newer block says what to do, and the page goes on with its jaws', () => {
  const {data, problem} = read({...bite, format: 2, made_by: 'ist 9'});
  assert.equal(data, null);
  assert.match(problem, /newer version \(ist 9\).*write the page again.*built-in jaws/);
});

test('damaged blocks are refused, with what is wrong', () => {
  assert.match(readDataBlock('{"format"').problem, /cut off/);
  for (const [block, wrong] of [
    [{...bite, kind: 'x'}, /its kind/],
    [{...bite, bodies: 3}, /no bodies/],
    [{...bite, bodies: [body('fixed')]}, /no moving body/],
    [{...bite, pose: [1, 2]}, /pose is not rigid/],
    [{...bite, pose: [NaN, ...identity.slice(1)]}, /pose is not rigid/],
    [{...bite, kind: 'bodies', bodies: []}, /no bodies/],
    [{...bite, missing: 'all'}, /missing/],
    [{...bite, missing: [1]}, /missing/],
    [{...bite, occlusion: {preset: 'scan', reach: NaN}}, /no preset or reach/],
    [{...bite, occlusion: undefined}, /no preset/],
    [{...bite, bodies: [{role: 'left'}]}, /no role/],
    [{...recording, metres_per_unit: 0}, /unit is missing/],
    [{...recording, recording: 1}, /no recording/],
    [{...recording, bodies: [body('fixed')]}, /body 0 has no rigid pose/],
    ['text', /no known format/],
  ]) {
    const {data, problem} = read(block);
    assert.equal(data, null);
    assert.match(problem, wrong);
  }
});

test('bytes come back from base64', () => {
  const bytes = Uint8Array.from({length: 100_000}, (_, at) => (at * 7919) % 256);
  assert.deepEqual(fromBase64(toBase64(bytes)), bytes);
});
