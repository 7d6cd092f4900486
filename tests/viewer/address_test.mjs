import assert from 'node:assert/strict';
import {test} from 'node:test';

import {makeAddress} from '../../src/viewer/page/state/address.js';

/** An address that is written with each step of a clock, for some seconds. */
function written(seconds, stepMilliseconds) {
  let time = 0;
  const found = [],
    calls = [];
  const set = makeAddress((fragment) => found.push({time, fragment}), {
    now: () => time,
    later: (call, milliseconds) => calls.push({at: time + milliseconds, call}),
  });
  const run = () => {
    for (const due of calls.filter(({at}) => at <= time)) {
      calls.splice(calls.indexOf(due), 1);
      due.call();
    }
  };
  let last = '';
  for (; time < 1000 * seconds; time += stepMilliseconds) {
    run();
    last = `#${time}`;
    set(last);
  }
  for (const end = time + 2000; time < end; time += 10) run();
  return {found, last};
}

test('a hand that is slow sees each change at once', () => {
  const {found} = written(60, 2000);
  assert.equal(found.length, 30);
  assert.ok(found.every(({time, fragment}) => fragment === `#${time}`));
});

test('of many changes the address gets fewer than browsers refuse, and the last one', () => {
  const {found, last} = written(90, 16);
  for (const {time} of found) {
    const near = found.filter((each) => each.time >= time && each.time < time + 30_000).length;
    assert.ok(near < 90, `${near} in 30 s`);
  }
  assert.equal(found.at(-1).fragment, last);
  assert.ok(found.length > 60, `${found.length}`);
});
