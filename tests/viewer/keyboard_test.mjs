import assert from 'node:assert/strict';
import {test} from 'node:test';

import {builtIn} from '../../src/viewer/page/facing.js';
import {listenToKeys} from '../../src/viewer/page/keyboard.js';
import {identity, translation} from '../../src/viewer/page/pose.js';
import {makeStore} from '../../src/viewer/page/state/store.js';

/** The picture's keys, without a browser: what a key does, and whether the page took it. */
function picture() {
  const listeners = {},
    done = [];
  const surface = {
    setAttribute: () => {},
    addEventListener: (name, listener) => {
      listeners[name] = listener;
    },
  };
  const stage = {
    drawn: true,
    surface,
    circle: (...by) => done.push(by.map(Math.sign)),
    home: () => done.push('home'),
  };
  globalThis.document = {addEventListener: () => {}};
  const store = makeStore({bodies: {moving: {extent: 1000}}, facing: builtIn, pose: [...identity], dragging: false});
  listenToKeys({store, stage, history: {}});
  const press = (key, more = {}) => {
    let taken = false;
    listeners.keydown({
      key,
      preventDefault: () => {
        taken = true;
      },
      ...more,
    });
    return taken;
  };
  return {store, done, press, listeners};
}
const shiftKey = true;

test('arrows turn the view; plus and minus change its distance, also where Shift makes the plus', () => {
  const {store, done, press} = picture();
  for (const [key, more, wanted] of [
    ['ArrowLeft', {}, [-1, 0, 1]],
    ['ArrowUp', {}, [0, -1, 1]],
    ['+', {}, [0, 0, 1]],
    ['+', {shiftKey}, [0, 0, 1]],
    ['-', {}, [0, 0, 1]],
    ['Home', {}, 'home'],
  ]) {
    assert.equal(press(key, more), true);
    assert.deepEqual(done.pop(), wanted);
  }
  assert.deepEqual(store.get().pose, [...identity]);
});

test('with Shift arrows move the body, until Shift is let go', () => {
  const {store, done, press, listeners} = picture();
  assert.equal(press('ArrowUp', {shiftKey}), true);
  assert.equal(press('PageDown', {shiftKey}), true);
  assert.deepEqual(store.get().pose, translation([0, -1, 1]));
  assert.equal(store.get().dragging, true);
  listeners.keyup({key: 'Shift'});
  assert.equal(store.get().dragging, false);
  assert.deepEqual(done, []);
});

test("other keys are the browser's", () => {
  const {press} = picture();
  for (const [key, more] of [
    ['a', {}],
    ['Tab', {shiftKey}],
    ['ArrowLeft', {ctrlKey: true}],
    ['+', {metaKey: true}],
  ])
    assert.equal(press(key, more), false);
});
