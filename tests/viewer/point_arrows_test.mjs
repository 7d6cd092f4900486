import assert from 'node:assert/strict';
import {test} from 'node:test';

import {makePointArrows} from '../../src/viewer/page/view/point_arrows.js';

test('each contact point has a dot and an arrow along its force, longer and redder for a larger force', () => {
  const drawn = [];
  const arrows = makePointArrows({add: (...objects) => drawn.push(...objects)});
  arrows.set(
    [
      {at: [1, 2, 3], force: [0, 0, 2], part: 0.2},
      {at: [4, 5, 6], force: [10, 0, 0], part: 1},
    ],
    100,
  );
  assert.equal(drawn.length, 4);
  const [weakDot, weak, strongDot, strong] = drawn;
  assert.deepEqual(weakDot.position.toArray(), [1, 2, 3]);
  assert.deepEqual(strong.position.toArray(), [4, 5, 6]);
  const length = ({line, cone}) => line.scale.y + cone.scale.y;
  assert.ok(
    Math.abs(length(strong) - 20) < 1e-9 && length(weak) > 3 && length(weak) < length(strong),
    `${length(weak)}, ${length(strong)}`,
  );
  // An arrow points along its own y axis.
  const along = weak.up.clone().set(0, 1, 0).applyQuaternion(strong.quaternion).toArray();
  [1, 0, 0].forEach((value, axis) => assert.ok(Math.abs(along[axis] - value) < 1e-9, `${along}`));
  assert.ok(strongDot.material.color.r > weakDot.material.color.r);

  arrows.set([{at: [7, 8, 9], force: [0, 0, 0], part: 0}], 100);
  assert.deepEqual(
    drawn.map(({visible}) => visible),
    [true, false, false, false],
  );
  arrows.set([], 100);
  assert.ok(drawn.every(({visible}) => !visible));
});
