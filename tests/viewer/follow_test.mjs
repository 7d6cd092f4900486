import assert from 'node:assert/strict';
import {test} from 'node:test';

import {EngineError} from '../../src/viewer/page/engine/engine_client.js';
import {followPose, isHere} from '../../src/viewer/page/follow.js';
import {makeStore} from '../../src/viewer/page/state/store.js';

const body = {rebuilds: true, unit: 'mm'};
const rested = 400; // milliseconds, after which a pose has rested

/** The page's answers, of an engine whose questions wait until the test answers them. */
function followed(change = {}) {
  const said = [],
    asked = [];
  const store = makeStore({
    bodies: {fixed: body, moving: body},
    trees: null,
    pose: [1],
    dragging: false,
    policy: null,
    stiffness: 0.1,
    tick: null,
    answer: null,
    cancelled: null,
    bite: null,
    wantsMap: false,
    preset: 'scan',
    reach: 2,
    unit: null,
    frame: '',
    ...change,
  });
  const ask = (name, question) =>
    new Promise((resolve, reject) => {
      asked.push({name, question, resolve, reject});
    });
  const dropped = [];
  const measurer = {
    ask,
    drop: (name) => {
      dropped.push(name);
      for (const each of asked.filter((each) => each.name === name)) each.reject(new EngineError('replaced', 'replaced'));
      asked.splice(0, asked.length, ...asked.filter((each) => each.name !== name));
    },
  };
  const {settled} = followPose({engine: {ask}, measurer, store, say: (text) => said.push(text)});
  const take = (name) => {
    const at = asked.findIndex((each) => each.name === name);
    assert.ok(at >= 0, `${name} is asked, not ${asked.map((each) => each.name).join()}`);
    const [found] = asked.splice(at, 1);
    return found;
  };
  return {store, said, asked, take, settled, dropped};
}
const wait = (milliseconds) =>
  new Promise((resolve) => {
    setTimeout(resolve, milliseconds);
  });

test('a tick is asked with each pose, the whole answer where it rests', async () => {
  const {store, asked, take, settled} = followed();
  store.set({trees: {}});
  store.set({pose: [2], dragging: true});
  assert.deepEqual(
    asked.map(({name, question}) => [name, question.pose]),
    [
      ['tick', [1]],
      ['tick', [2]],
    ],
  );
  await wait(rested);
  assert.equal(asked.length, 2, 'a hand still drags it');
  store.set({dragging: false});
  assert.equal(asked.length, 2, 'it does not rest yet');
  await wait(rested);
  const answer = take('collide');
  assert.deepEqual(answer.question.pose, [2]);
  for (const tick of [take('tick'), take('tick')]) tick.resolve({touch: 'no'});
  assert.equal(settled(), false);
  answer.resolve({line: {}});
  await wait(0);
  assert.equal(settled(), true);
  assert.deepEqual(store.get().answer.pose, [2]);
  assert.equal(asked.length, 0, 'no map is wanted');
});

test('a map that was measured by other settings than are shown is not shown, and another is made', async () => {
  const {store, take} = followed({wantsMap: true});
  store.set({trees: {}});
  await wait(rested);
  const first = take('occlusion');
  assert.equal(first.question.preset, 'scan');
  store.set({preset: 'stl'});
  first.resolve({bite: 'of scan'});
  await wait(rested);
  assert.equal(store.get().bite, null);
  const second = take('occlusion');
  assert.equal(second.question.preset, 'stl');
  second.resolve({bite: 'of stl'});
  await wait(0);
  assert.equal(store.get().bite.bite, 'of stl');
});

test('a map of a pose that is gone ends, and that of the pose where it rests is made', async () => {
  const {store, said, asked, take, dropped} = followed({wantsMap: true});
  store.set({trees: {}});
  await wait(rested);
  store.set({preset: 'stl'});
  store.set({pose: [2], dragging: true});
  store.set({pose: [3]});
  assert.deepEqual(dropped, ['occlusion']);
  await wait(rested);
  assert.ok(!asked.some(({name}) => name === 'occlusion'), 'a hand still drags it');
  store.set({dragging: false});
  await wait(rested);
  const second = take('occlusion');
  assert.deepEqual(second.question.pose, [3]);
  second.resolve({bite: 'of 3'});
  await wait(0);
  store.set({pose: [4]});
  assert.deepEqual([dropped, said, store.get().wantsMap, store.get().bite.bite], [['occlusion'], [], true, 'of 3']);
});

test('answers of trees that went are passed over, without a word', async () => {
  const {store, said, take} = followed();
  store.set({trees: {}});
  await wait(rested);
  const tick = take('tick'),
    answer = take('collide');
  store.set({trees: null});
  tick.reject(new EngineError('argument-invalid', 'the trees are not built'));
  answer.resolve({line: {}});
  await wait(0);
  assert.equal(store.get().answer, null);
  assert.deepEqual(said, []);
});

test('an answer that is cancelled is not asked again before the pose is another', async () => {
  const {store, said, asked, take, settled} = followed();
  store.set({trees: {}});
  await wait(rested);
  take('tick').resolve({touch: 'no'});
  take('collide').reject(new EngineError('cancelled', 'cancelled'));
  await wait(0);
  assert.deepEqual(store.get().cancelled, {pose: [1], policy: null});
  assert.ok(isHere(store.get(), store.get().cancelled));
  store.set({wantsMap: true});
  await wait(rested);
  take('occlusion').resolve({});
  await wait(0);
  assert.deepEqual([asked, said, settled()], [[], [], true]);
  store.set({policy: 'tight'});
  await wait(rested);
  assert.equal(take('collide').question.policy, 'tight');
  assert.equal(isHere(store.get(), store.get().cancelled), false);
});

test('a map that is cancelled is not made again until it is asked for', async () => {
  const {store, said, asked, take} = followed({wantsMap: true});
  store.set({trees: {}});
  await wait(rested);
  take('occlusion').reject(new EngineError('cancelled', 'cancelled'));
  await wait(rested);
  assert.equal(store.get().wantsMap, false);
  assert.deepEqual(said, []);
  assert.ok(!asked.some(({name}) => name === 'occlusion'));
  store.set({wantsMap: true});
  await wait(rested);
  take('occlusion');
});
