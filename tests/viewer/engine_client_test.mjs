import assert from 'node:assert/strict';
import {test} from 'node:test';

import {makeEngineClient} from '../../src/viewer/page/engine/engine_client.js';

const wait = () =>
  new Promise((resolve) => {
    setTimeout(resolve);
  });

/** A client of Workers that answer what the test says, when it says so. */
function client({restore = async () => {}, lazy = false} = {}) {
  const workers = [],
    bars = [],
    lost = [];
  const start = () => {
    const worker = {
      asked: [],
      ended: false,
      postMessage: (message) => worker.asked.push(message),
      terminate: () => {
        worker.ended = true;
      },
    };
    Object.assign(worker, {
      say: (data) => worker.onmessage({data}),
      ready: () => worker.say({ready: true, version: 'v', target: 't'}),
      answer: (answer) => worker.say({id: worker.asked.at(-1).id, answer, milliseconds: 1}),
      names: () => worker.asked.map(({question}) => question),
    });
    workers.push(worker);
    return worker;
  };
  const progress = {begin: (...words) => bars.push(words), advance: () => {}, end: () => bars.push('end')};
  return {...makeEngineClient({start, progress, restore, onLost: (error) => lost.push(error.message), lazy}), workers, bars, lost};
}
const codeOf = (asked) =>
  asked.then(
    () => 'answered',
    ({code}) => code,
  );

test('questions are asked one after the other; a later one of a name replaces the one that waits', async () => {
  const {
    ask,
    workers: [worker],
    busy,
  } = client();
  const first = ask('a', {}),
    old = codeOf(ask('tick', {at: 1}, {latest: true})),
    last = ask('b', {}),
    tick = ask('tick', {at: 2}, {latest: true, first: true});
  assert.deepEqual([worker.names(), await old], [[], 'replaced']);
  worker.ready();
  for (const [asked, name] of [
    [tick, 'tick'],
    [first, 'a'],
    [last, 'b'],
  ]) {
    assert.equal(worker.names().at(-1), name);
    worker.answer(name);
    assert.equal(await asked, name);
  }
  assert.deepEqual([worker.asked[0].asked, busy()], [{at: 2}, false]);
});

test('the bar of what is often asked knows that it is seldom long', () => {
  const {
    ask,
    workers: [worker],
    bars,
  } = client();
  worker.ready();
  ask('a', {}, {doing: 'A'});
  ask('b', {}, {doing: 'B', seldomLong: true});
  worker.answer();
  assert.deepEqual(
    bars.filter((each) => each !== 'end'),
    [
      ['A', true, undefined],
      ['B', true, true],
    ],
  );
});

test('what is cancelled ends with its Worker; the next one gets the bodies before it is asked', async () => {
  const made = client({restore: (again) => again('bodies', {})});
  const {ask, workers, cancel} = made;
  workers[0].ready();
  const lost = codeOf(ask('long', {})),
    waits = ask('tick', {});
  cancel();
  assert.deepEqual([await lost, workers.length, workers[0].ended], ['cancelled', 2, true]);
  cancel();
  assert.equal(workers.length, 2, 'the bodies are needed');
  workers[1].ready();
  assert.deepEqual(workers[1].names(), ['bodies']);
  workers[1].answer();
  await wait();
  workers[0].say({id: workers[1].asked.at(-1).id, answer: 'of a Worker that is gone'});
  workers[1].answer('tick');
  assert.equal(await waits, 'tick');
});

test('a lazy client starts its Worker when it is asked, and has it restored first', async () => {
  const {ask, workers, busy, bars} = client({lazy: true, restore: (again) => again('bodies', {})});
  assert.deepEqual([workers.length, busy()], [0, false]);
  const map = ask('map', {}, {doing: 'Mapping'});
  workers[0].ready();
  workers[0].answer();
  await wait();
  workers[0].answer('map');
  assert.equal(await map, 'map');
  assert.deepEqual(workers[0].names(), ['bodies', 'map']);
  assert.deepEqual(
    bars.filter((each) => each !== 'end').map(([words]) => words),
    ['Starting a second engine', 'Mapping'],
  );
  const again = ask('map', {});
  workers[0].answer('again');
  assert.equal(await again, 'again');
  assert.equal(workers.length, 1);
});

test('what a lazy client drops ends with its Worker, and the rest is asked of another', async () => {
  const {ask, workers, drop, busy} = client({lazy: true});
  const map = codeOf(ask('map', {})),
    glb = ask('glb', {});
  workers[0].ready();
  await wait();
  assert.deepEqual(workers[0].names(), ['map']);
  drop('map');
  assert.deepEqual([await map, workers[0].ended], ['replaced', true]);
  workers[1].ready();
  await wait();
  drop('map');
  workers[1].answer('glb');
  assert.deepEqual([await glb, workers.length, busy()], ['glb', 2, false]);
  drop();
  assert.deepEqual([workers[1].ended, workers.length], [true, 2]);
});

test('a Worker that still gets bodies ends where they are old, and no other gets those', async () => {
  const reads = [];
  const {ask, workers, drop, cancel} = client({
    lazy: true,
    restore: async (again) => {
      const of = reads.length;
      await new Promise((resolve) => {
        reads.push(resolve);
      });
      await again('bodies', {of});
    },
  });
  const old = codeOf(ask('map', {}));
  workers[0].ready();
  drop();
  assert.equal(await old, 'replaced');
  const map = codeOf(ask('map', {}));
  workers[1].ready();
  for (const resolve of reads) resolve();
  await wait();
  assert.deepEqual([workers[0].names(), workers[1].asked.map(({asked}) => asked)], [[], [{of: 1}]]);
  cancel();
  assert.deepEqual([await map, workers[1].ended, workers.length], ['cancelled', true, 2]);
});

test('where the bodies cannot be given again, somebody hears of it', async () => {
  const {ask, workers, lost, drop, busy} = client({lazy: true, restore: () => Promise.reject(new Error('a.stl: it changed'))});
  const map = codeOf(ask('map', {}));
  workers[0].ready();
  await wait();
  assert.deepEqual(lost, ['a.stl: it changed']);
  drop(undefined, 'cancelled');
  assert.deepEqual([await map, busy()], ['cancelled', false]);
});
