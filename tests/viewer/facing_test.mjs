import assert from 'node:assert/strict';
import {test} from 'node:test';

import {builtIn, directionWords, facingOf, swapped} from '../../src/viewer/page/facing.js';
import {identity} from '../../src/viewer/page/pose.js';

test('the moving body closes against the way to it, and up is where the upper one lies', () => {
  const seen = (towards, upper) => facingOf({known: true, towards, front: [1, 0, 0], upper});
  assert.deepEqual(seen([0, -1, 0], 'fixed'), {known: true, upper: 'fixed', front: [1, 0, 0], closing: [0, 1, 0], up: [0, 1, 0]});
  assert.deepEqual(seen([0, 1, 0], 'moving').up, [0, 1, 0]);
  assert.deepEqual(seen([0, 1, 0], 'moving').closing, [0, -1, 0]);
  assert.deepEqual(facingOf({known: false}), {...builtIn, known: false});
});

test('bodies that swap their roles face each other the other way, in coordinates of the other one', () => {
  const quarter = [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1]; // x to y
  const from = facingOf({known: true, towards: [0, -1, 0], front: [1, 0, 0], upper: 'fixed'});
  const to = swapped(from, quarter);
  assert.deepEqual([to.upper, to.up, to.closing, to.front], ['moving', [1, 0, 0], [-1, 0, 0], [0, -1, 0]]);
  assert.deepEqual(swapped(swapped(from, [...identity]), [...identity]), from);
});

test('directions are axes where they are', () => {
  assert.equal(directionWords([0, 0, 1]), 'z');
  assert.equal(directionWords([-1, 0, 0]), '−x');
  assert.equal(directionWords([0, -0.6, 0.8]), '(0.00, −0.60, 0.80)');
});
