import assert from 'node:assert/strict';
import {test} from 'node:test';

import {partAt, scaleOf, thinned, ticksOf, valueAt} from '../../src/viewer/page/ui/plot_scale.js';

test('a scale holds its values, and passes over what has no place', () => {
  assert.deepEqual(scaleOf([3, NaN, 1, Infinity], false), {from: 1, to: 3, logarithmic: false});
  const scale = scaleOf([0, -1, 1, 100], true);
  assert.ok(scale.from < 1 && scale.from > 0 && scale.to > 100);
});

test('no value and one value still make an axis', () => {
  for (const logarithmic of [false, true]) {
    for (const values of [[], [5]]) {
      const {from, to} = scaleOf(values, logarithmic);
      assert.ok(from < to);
    }
  }
  const {from, to} = scaleOf([0], false);
  assert.ok(from < 0 && to > 0);
});

test("places and values are each other's inverse", () => {
  for (const logarithmic of [false, true]) {
    const scale = {from: 0.5, to: 80, logarithmic};
    assert.equal(partAt(scale, 0.5), 0);
    assert.ok(Math.abs(partAt(scale, 80) - 1) < 1e-12);
    assert.ok(Math.abs(valueAt(scale, partAt(scale, 7)) - 7) < 1e-12);
  }
});

test('ticks are round, inside and not too many', () => {
  assert.deepEqual(ticksOf({from: 0, to: 1, logarithmic: false}, 5), [0, 0.2, 0.4, 0.6, 0.8, 1]);
  assert.deepEqual(ticksOf({from: 0.5, to: 60, logarithmic: true}, 5), [0.5, 1, 2, 5, 10, 20, 50]);
  for (const scale of [
    {from: 1e-5, to: 3e6, logarithmic: true},
    {from: -7, to: 1234, logarithmic: false},
    {from: 1, to: 2, logarithmic: true},
  ]) {
    const ticks = ticksOf(scale, 5);
    assert.ok(ticks.length >= 2 && ticks.length <= 12, String(ticks));
    assert.ok(ticks.every((tick) => tick >= scale.from && tick <= scale.to));
  }
});

test('a thinned line keeps its peaks and its order', () => {
  const points = Array.from({length: 10_000}, (_, at) => [at, at === 4321 ? 9 : Math.sin(at)]);
  const kept = thinned(points, 100);
  assert.ok(kept.length <= 200);
  assert.ok(kept.some(([x, y]) => x === 4321 && y === 9));
  assert.ok(kept.every(([x], at) => at === 0 || kept[at - 1][0] < x));
  assert.equal(thinned(points.slice(0, 50), 100).length, 50);
});
