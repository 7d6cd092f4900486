import assert from 'node:assert/strict';
import {test} from 'node:test';

import {mappedFirst} from '../../src/viewer/page/view/mapped_triangles.js';

test('a map is drawn on triangles where it is known and no steeper than a distance', () => {
  const positions = new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 2, 0, 0]);
  const triangles = new Uint32Array([0, 1, 2, 1, 3, 2, 1, 4, 3]);
  const sorted = (distances) => {
    const {triangles: found, mapped} = mappedFirst(positions, triangles, new Float32Array(distances));
    return [[...found.subarray(0, mapped)], [...found.subarray(mapped)]];
  };
  assert.deepEqual(sorted([0, 0.5, 0, 0.5, 0.5]), [[...triangles], []]);
  assert.deepEqual(sorted([NaN, 0.5, 0, 0.5, 0.5]), [
    [1, 3, 2, 1, 4, 3],
    [0, 1, 2],
  ]);
  // The sign of one corner is wrong.
  assert.deepEqual(sorted([0, 0.9, 0, 0.9, -0.9])[1], [1, 4, 3]);
});
