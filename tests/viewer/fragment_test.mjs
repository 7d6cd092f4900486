import assert from 'node:assert/strict';
import {test} from 'node:test';

import {readFragment, writeFragment} from '../../src/viewer/page/state/fragment.js';
import {translation} from '../../src/viewer/page/pose.js';

const panels = ['pose', 'occlusion'];
const state = {
  panel: 'occlusion',
  pose: translation([0.1, 0, -1.5]),
  voxelSize: 0.4,
  policy: 'tight',
  preset: 'owens',
  theme: 'dark',
  seed: 7,
};

test('a state comes back from its fragment, bit for bit in the pose', () => {
  const {change, problems} = readFragment(writeFragment(state), panels);
  assert.deepEqual(problems, []);
  assert.deepEqual(change, state);
});

test('nothing is read from an empty fragment', () => {
  assert.deepEqual(readFragment('', panels), {change: {}, problems: []});
});

test('each wrong part gets its sentence, and the others are taken', () => {
  const {change, problems} = readFragment('#panel=nowhere&pose=1,2,3&voxel=-1&policy=loose&preset=x&theme=red&seed=a', panels);
  assert.deepEqual(change, {});
  assert.equal(problems.length, 7);
  for (const problem of problems) assert.match(problem, /is not .*: the page starts without it\./);
  assert.deepEqual(readFragment('#pose=1,2&voxel=0.5', panels).change, {voxelSize: 0.5});
});

test('a pose with empty, infinite or stretched numbers is refused', () => {
  for (const pose of ['1,0,0,0,0,1,0,0,0,0,1,0,0,0,,1', '1,0,0,0,0,1,0,0,0,0,1,0,0,0,Infinity,1', '2,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1']) {
    assert.equal(readFragment(`#pose=${pose}`, panels).problems.length, 1);
  }
});
