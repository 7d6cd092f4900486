import assert from 'node:assert/strict';
import {test} from 'node:test';

import {
  fromSixNumbers,
  identity,
  inverse,
  isRigid,
  matrixText,
  moved,
  multiply,
  parseMatrix,
  toSixNumbers,
  transformed,
  translation,
} from '../../src/viewer/page/pose.js';

const near = (a, b, to = 1e-12) => a.forEach((value, at) => assert.ok(Math.abs(value - b[at]) <= to, `${at}: ${value} and ${b[at]}`));
const some = fromSixNumbers({shift: [1, -2, 3], turn: [20, -35, 70]}, [5, 6, 7]);

test('six numbers come back from the pose that they make', () => {
  const {shift, turn} = toSixNumbers(some, [5, 6, 7]);
  near(shift, [1, -2, 3]);
  near(turn, [20, -35, 70]);
});

test('a body turns about its middle, which only the shift moves', () => {
  near(transformed(some, [5, 6, 7]), [6, 4, 10]);
});

test('looking straight up, the six numbers still make the same pose', () => {
  for (const turn of [
    [25, 90, 0],
    [25, -90, 0],
  ]) {
    const pose = fromSixNumbers({shift: [0, 0, 0], turn}, [1, 2, 3]);
    near(fromSixNumbers(toSixNumbers(pose, [1, 2, 3]), [1, 2, 3]), pose, 1e-7);
  }
});

test('turns about one axis are right-handed', () => {
  near(transformed(fromSixNumbers({shift: [0, 0, 0], turn: [0, 0, 90]}, [0, 0, 0]), [1, 0, 0]), [0, 1, 0]);
  near(transformed(fromSixNumbers({shift: [0, 0, 0], turn: [90, 0, 0]}, [0, 0, 0]), [0, 1, 0]), [0, 0, 1]);
  near(transformed(fromSixNumbers({shift: [0, 0, 0], turn: [0, 90, 0]}, [0, 0, 0]), [0, 0, 1]), [1, 0, 0]);
});

test('the inverse leads back', () => {
  near(multiply(some, inverse(some)), identity);
  near(moved(some, [0, 0, 2]), multiply(translation([0, 0, 2]), some));
});

test('four rows and 16 numbers column by column are one matrix', () => {
  near(parseMatrix(matrixText(some)), some, 0);
  near(parseMatrix(some.join(', ')), some, 0);
  near(parseMatrix(JSON.stringify(some)), some, 0);
  near(parseMatrix('[[1,0,0,0],\n[0,1,0,0],\n[0,0,1,-1.5e0],\n[0,0,0,1]]'), translation([0, 0, -1.5]), 0);
});

test('what is no pose is refused, with what to do', () => {
  assert.throws(() => parseMatrix('1 2 3'), /has 3: paste them/);
  assert.throws(() => parseMatrix(`${'1 '.repeat(15)} nan`), /not finite/);
  assert.throws(() => parseMatrix(`2 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1`), /no rigid pose/);
  assert.throws(() => parseMatrix('1 0 0 5  0 1 0 0  0 0 1 0  0 0 0 1'), /row by row: put them in four lines/);
  assert.throws(() => parseMatrix('1 0 0 0\n0 1 0 0\n0 0 1 0\n5 0 0 1'), /column by column: put the 16 numbers in one line/);
});

test('a rough rotation is a pose, and a scaled one is none', () => {
  const diagonal = (/** @type {number[]} */ [x, y, z]) => [x, 0, 0, 0, 0, y, 0, 0, 0, 0, z, 0, 0, 0, 0, 1];
  assert.equal(isRigid([1, 9e-4, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]), true);
  assert.equal(isRigid([1, 2e-3, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]), false);
  assert.equal(isRigid(diagonal([1 + 4e-4, 1, 1 - 4e-4])), true);
  for (const scale of [1 + 9e-6, 1 - 9e-6]) assert.equal(isRigid(diagonal([scale, scale, scale])), true);
  for (const scale of [1 + 1.1e-5, 1 - 1.1e-5, 1.0004, 2]) assert.equal(isRigid(diagonal([scale, scale, scale])), false);
});

test('a mirror is no pose', () => {
  assert.equal(isRigid([-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]), false);
  assert.equal(isRigid(some), true);
  assert.equal(isRigid([...some.slice(0, 15), 2]), false);
  assert.equal(isRigid([...some.slice(0, 15), NaN]), false);
});
