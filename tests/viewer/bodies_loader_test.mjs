import assert from 'node:assert/strict';
import {test} from 'node:test';

import {makeBodiesLoader} from '../../src/viewer/page/bodies_loader.js';
import {EngineError} from '../../src/viewer/page/engine/engine_client.js';
import {identity, translation} from '../../src/viewer/page/pose.js';
import {makeStore} from '../../src/viewer/page/state/store.js';

const facts = (name, extent, unit = null) => ({name, extent, unit, warnings: [], info: {}, rebuilds: true});
const trees = {policies: ['simple', 'slab'], fixed: {}, moving: {}};
const file = (role, name, unit) => ({role, name, content: new Blob(['solid']), unit});

/** A loader over an engine that answers as it is said to, or throws what it is given. */
function made(answers) {
  const said = [],
    asked = [];
  const store = makeStore({
    bodies: {fixed: null, moving: null},
    trees: null,
    policy: null,
    pose: [...identity],
    home: [...identity],
    dragging: false,
  });
  const ask = async (name, question) => {
    asked.push([name, question]);
    const answer = await {facing: () => ({known: false}), swap: () => ({}), ...answers}[name](question);
    if (answer instanceof Error) throw answer;
    return answer;
  };
  return {loader: makeBodiesLoader({store, ask, say: (text, kind) => said.push([kind, text])}), store, said, asked};
}
const jaws = {fixed: facts('upper', 110), moving: facts('lower', 110)};

test('a build that is cancelled or replaced was not done, and nothing is said of it', async () => {
  for (const code of ['cancelled', 'replaced']) {
    let outcome = trees;
    const {loader, store, said} = made({make_jaws: () => jaws, build: () => outcome});
    assert.equal(await loader.makeJaws(1), true);
    assert.equal(await loader.build(0.4), true);
    outcome = new EngineError(code, code);
    assert.equal(await loader.build(0.2), false);
    assert.deepEqual(said, []);
    assert.equal(store.get().voxelSize, 0.4);
  }
});

test('a build that is refused says that the trees of before are kept', async () => {
  let outcome = new EngineError('memory-limit', 'it takes too much.');
  const {loader, said} = made({make_jaws: () => jaws, build: () => outcome});
  await loader.makeJaws(1);
  assert.equal(await loader.build(1e-4), false);
  assert.deepEqual(said.pop(), ['error', 'It takes too much. There are no trees yet: choose another voxel size.']);
  outcome = trees;
  await loader.build();
  outcome = new EngineError('memory-limit', 'it takes too much.');
  assert.equal(await loader.build(1e-4), false);
  assert.match(said.pop()[1], /The trees of before are kept/);
});

test('bodies that come in place of others are there without trees too', async () => {
  const {loader, store} = made({open: ({name}) => facts(name, 1), build: () => new EngineError('cancelled', '')});
  assert.equal(await loader.replace([file('fixed', 'a.ist'), file('moving', 'b.ist')]), true);
  assert.equal(store.get().bodies.moving.name, 'b.ist');
  assert.equal(store.get().trees, null);
});

test('another engine gets what this one had: files, their units, and the voxel size', async () => {
  const {loader} = made({make_jaws: () => jaws, open: ({name, unit}) => facts(name, 100, unit), build: () => trees});
  const restored = async () => {
    const again = [];
    await loader.restore(async (name, {bytes, ...question}) => {
      again.push([name, question]);
    });
    return again;
  };
  await loader.makeJaws(3);
  assert.deepEqual(await restored(), [['make_jaws', {seed: 3}]]);
  await loader.open(file('moving', 'other.stl', 'mm'));
  await loader.build(0.5);
  const opened = ['open', {role: 'moving', name: 'other.stl', unit: 'mm'}],
    built = ['build', {voxel_size: 0.5}];
  assert.deepEqual(await restored(), [['make_jaws', {seed: 3}], opened, built]);
  await loader.open(file('fixed', 'first.stl'));
  assert.deepEqual(await restored(), [opened, ['open', {role: 'fixed', name: 'first.stl', unit: undefined}]]);
});

test('bodies in two frames are said, and the moving one is turned if that is asked', async () => {
  const {loader, said, asked} = made({
    open: ({name, role, to_frame}) => ({...facts(name, 100), info: {frame: to_frame ?? (role === 'fixed' ? 'ras' : 'lps')}}),
    build: () => trees,
  });
  await loader.open(file('fixed', 'a.stl'));
  assert.deepEqual(said, []);
  await loader.open(file('moving', 'b.stl'));
  assert.match(said.pop()[1], /^a\.stl says that it is in the frame RAS, and b\.stl in LPS\./);
  assert.equal(await loader.turn(), true);
  assert.equal(asked.at(-1)[1].to_frame, 'ras');
  assert.deepEqual(said, []);
  const again = [];
  await loader.restore(async (name, question) => again.push(question.to_frame));
  assert.deepEqual(again, [undefined, 'ras']);
});

test('the pose that two bodies came with is home until both have given way', async () => {
  const {loader, store} = made({make_jaws: () => jaws, open: ({name}) => facts(name, 100), build: () => trees});
  const home = () => store.get().home;
  await loader.replace([file('fixed', 'a.ist'), file('moving', 'b.ist')], translation([1, 2, 3]));
  assert.deepEqual(home(), translation([1, 2, 3]));
  await loader.open(file('moving', 'c.stl'));
  await loader.open(file('moving', 'd.stl'));
  assert.deepEqual(home(), translation([1, 2, 3]), 'it may be the same body, scanned again');
  await loader.open(file('fixed', 'e.stl'));
  assert.deepEqual(home(), [...identity]);
  await loader.replace([file('fixed', 'a.ist'), file('moving', 'b.ist')], translation([1, 2, 3]));
  await loader.makeJaws(2);
  assert.deepEqual(home(), [...identity]);
});

test('a file that is opened alone empties the other place, and no built-in jaw is left', async () => {
  const {loader, store, said, asked} = made({make_jaws: () => jaws, open: ({name}) => facts(name, 100), build: () => trees});
  await loader.makeJaws(1);
  await loader.open(file('moving', 'a.stl'));
  assert.match(said.pop()[1], /^a\.stl is measured against a built-in jaw, upper:/);
  await loader.makeJaws(1);
  await loader.open(file('fixed', 'a.stl'), true);
  assert.deepEqual(store.get().bodies, {fixed: facts('a.stl', 100), moving: null});
  assert.deepEqual(said, []);
  await loader.build();
  assert.equal(store.get().trees, null, 'there is nothing to measure it against');
  await loader.open(file('moving', 'b.stl'));
  const again = [];
  await loader.restore(async (name) => again.push(name));
  assert.deepEqual(again, ['open', 'open']);
  assert.equal(asked.filter(([name]) => name === 'build').length, 0);
});

test('the lower body moves, whichever came first, and closes along what its normals say', async () => {
  for (const [upper, swaps] of [
    ['fixed', false],
    ['moving', true],
  ]) {
    const facing = {known: true, towards: [0, swaps ? 1 : -1, 0], front: [0, 0, 1], upper};
    const {loader, store, said, asked} = made({open: ({name}) => facts(name, 100), build: () => trees, facing: () => facing});
    await loader.open(file('fixed', 'a.stl'), true);
    await loader.open(file('moving', 'b.stl'));
    await loader.guessRoles();
    await loader.build();
    const {bodies, facing: found} = store.get();
    assert.deepEqual([bodies.fixed.name, bodies.moving.name], swaps ? ['b.stl', 'a.stl'] : ['a.stl', 'b.stl']);
    assert.deepEqual([found.closing, found.up, found.front, found.upper], [[0, 1, 0], [0, 1, 0], [0, 0, 1], 'fixed']);
    assert.equal(asked.filter(([name]) => name === 'facing').length, 1, 'a build does not ask again');
    assert.equal(said.length, swaps ? 1 : 0);
    if (swaps) assert.match(said[0][1], /^a\.stl lies below, so it is the moving body, which closes along y\./);
    const again = [];
    await loader.restore(async (name, {role, name: of}) => again.push([name, role, of]), false);
    assert.deepEqual(again.sort(), [
      ['open', 'fixed', bodies.fixed.name],
      ['open', 'moving', bodies.moving.name],
    ]);
  }
});

test('bodies whose roles nobody can tell keep them', async () => {
  const {loader, store} = made({
    open: ({name}) => facts(name, 100),
    facing: () => ({known: false, towards: [0, 0, 1], front: [0, -1, 0], upper: 'moving'}),
  });
  await loader.open(file('fixed', 'a.stl'), true);
  await loader.open(file('moving', 'b.stl'));
  await loader.guessRoles();
  assert.equal(store.get().bodies.fixed.name, 'a.stl');
});

test('a swap keeps the bodies where they are to each other', async () => {
  const {loader, store} = made({open: ({name}) => facts(name, 100), build: () => trees});
  await loader.replace([file('fixed', 'a.stl'), file('moving', 'b.stl')], translation([1, 2, 3]));
  const {closing} = store.get().facing;
  await loader.swap();
  assert.deepEqual(store.get().pose, translation([-1, -2, -3]));
  assert.deepEqual(store.get().home, store.get().pose);
  assert.equal(store.get().trees, null);
  assert.deepEqual(
    store.get().facing.closing,
    closing.map((value) => 0 - value),
  );
  await loader.swap();
  assert.deepEqual(store.get().pose, translation([1, 2, 3]));
});

test('a body in inches beside a built-in jaw, which is in millimetres, gets a warning', async () => {
  const {loader, said} = made({make_jaws: () => jaws, open: ({name}) => facts(name, 110, 'inch')});
  await loader.makeJaws(1);
  await loader.open(file('fixed', 'a.ist'));
  assert.match(said.pop()[1], /^a\.ist is in inches, and lower in millimetres\. .*convert one of them/);
});

test('a build of two units says nothing of the voxel size', async () => {
  const fault = 'query: the fixed tree is in mm, and the moving tree is in inch: convert one mesh';
  const {loader, said} = made({make_jaws: () => jaws, build: () => new EngineError('argument-invalid', fault)});
  await loader.makeJaws(1);
  assert.equal(await loader.build(), false);
  assert.deepEqual(said.pop(), ['error', `Q${fault.slice(1)}. There are no trees yet.`]);
});

test('bodies that cannot be in one unit get a warning, others get none', async () => {
  const pairs = [
    [['mm', 110], ['m', 110], /^a\.stl is in millimetres, and b\.stl in metres\. .*convert one of them, and open it again/],
    [[null, 110], ['inch', 4.3], /^a\.stl is 26 times as large as b\.stl: one of them may be in metres or inches/],
    [['mm', 110], [null, 110], null],
    [[null, 4.3], ['inch', 4.3], /^b\.stl is in inches, and no unit is known of a\.stl, so inches are assumed\. .*choose that as the unit/],
    [['m', 0.11], ['m', 0.02], null],
  ];
  for (const [fixed, moving, sentence] of pairs) {
    const bodies = {'a.stl': fixed, 'b.stl': moving};
    const {loader, said} = made({open: ({name}) => facts(name, bodies[name][1], bodies[name][0])});
    await loader.open(file('fixed', 'a.stl'));
    said.length = 0;
    await loader.open(file('moving', 'b.stl'));
    assert.equal(said.length, sentence ? 1 : 0, said.join());
    if (sentence) assert.match(said[0][1], sentence);
  }
});
