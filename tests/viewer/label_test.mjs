import assert from 'node:assert/strict';
import {test} from 'node:test';

import {uncovered} from '../../src/viewer/page/view/label.js';

test('a box that meets an earlier one is covered, and covers nothing itself', () => {
  const box = (x, y) => ({x, y, width: 2, height: 1});
  assert.deepEqual(uncovered([box(0, 0), box(1.5, 0), box(3, 0), box(1.5, 1), box(0, 0.9)]), [true, false, true, true, false]);
});
