// The page's answers are the command's, bit for bit: node runs the page's engine, and the command
// answers the same questions about the same files.
//
//   IST_ENGINE   folder of engine.js and engine.wasm
//   IST_COMMAND  the ist command of the same sources

import assert from 'node:assert/strict';
import {mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import path from 'node:path';
import {after, before, test} from 'node:test';

import {answerOf, ist as istIn, linesOf} from './command.mjs';
import {startEngine} from './engine.mjs';

const folder = mkdtempSync(path.join(tmpdir(), 'ist-page-'));
const upper = 'upper_jaw.stl',
  lower = 'lower_jaw.stl';
const shifts = [-5, -2, -1.5, -0.6, 0];
const poses = shifts.map((dz) => [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, dz, 1]);
let engine;

const ist = (...words) => istIn(folder, ...words);

// The page and the command may be built at different commits.
function withoutCommit({commit, ...rest}) {
  assert.match(commit, /^(unknown|[0-9a-f]{8,}\+?)$/);
  return rest;
}

before(async () => {
  ist('demo', '--voxel-size', '2', '--keep', '.');
  writeFileSync(path.join(folder, 'poses.json'), JSON.stringify(poses.map((pose) => ({pose}))));
  engine = await startEngine(process.env.IST_ENGINE);
});
after(() => rmSync(folder, {recursive: true}));

test('says its version and its instruction set', () => {
  assert.match(engine.about.version, /^ist \d+\.\d+\.\d+, commit /);
  assert.ok(engine.about.target.startsWith('simd128'), engine.about.target);
});

test('refuses questions before there are bodies, and unknown ones', () => {
  assert.throws(() => engine.ask('collide', {pose: poses[0]}), {code: 'argument-invalid'});
  assert.throws(() => engine.ask('build', {voxel_size: 1}), /fixed body/);
  assert.throws(() => engine.ask('dance', {}), /dance/);
});

test('describes the built-in jaws as the command describes their files', () => {
  const bodies = engine.ask('make_jaws', {seed: 1});
  for (const [role, file] of [
    ['fixed', upper],
    ['moving', lower],
  ]) {
    assert.deepEqual(bodies[role].info, linesOf(ist('info', file, '--json'))[1]);
    assert.equal(bodies[role].triangles.length, 3 * bodies[role].info.triangles);
    assert.equal(bodies[role].positions.length, 3 * bodies[role].info.vertices);
  }
});

for (const size of [2, 0.8, 0.4]) {
  test(`answers at five poses as the command does, voxels of ${size} mm`, () => {
    engine.ask('make_jaws', {seed: 1});
    const trees = engine.ask('build', {voxel_size: size});
    assert.deepEqual(trees.policies, ['simple', 'table', 'tight', 'slab']);
    const [header, ...lines] = linesOf(ist('collide', upper, lower, '--voxel-size', `${size}`, '--poses', 'poses.json', '--json'));
    assert.equal(lines.length, poses.length);
    poses.forEach((pose, i) => {
      const answer = engine.ask('collide', {pose});
      assert.deepEqual(withoutCommit(answer.header), withoutCommit(header));
      assert.deepEqual(answerOf(answer.line), answerOf({...lines[i], index: 0}));
      assert.ok(answer.microseconds > 0);
    });
    for (const policy of ['simple', 'table', 'tight']) {
      const [, line] = linesOf(
        ist('collide', upper, lower, '--voxel-size', `${size}`, '--move', '0,0,-0.6', '--spheres', policy, '--json'),
      );
      assert.deepEqual(answerOf(engine.ask('collide', {pose: poses[3], policy}).line), answerOf(line));
    }
  });
}

test('saves the tree that the command builds, and reads it', () => {
  ist('build', lower, '-o', 'lower.ist', '--voxel-size', '0.8');
  engine.ask('make_jaws', {seed: 1});
  engine.ask('build', {voxel_size: 0.8});
  const bytes = readFileSync(path.join(folder, 'lower.ist'));
  assert.ok(bytes.equals(engine.ask('save_body', {role: 'moving'}).bytes));
  const read = engine.open('moving', 'lower.ist', bytes);
  // The times of its levels are a machine's, and its memory depends on how long an address is.
  const bodyOf = (info) => ({...info, memory: 0, levels: info.levels.map(({milliseconds, ...level}) => level)});
  assert.deepEqual(bodyOf(read.info), bodyOf(linesOf(ist('info', 'lower.ist', '--json'))[1]));
  assert.equal(read.rebuilds, true);
});

test('follows each stage of a build', () => {
  engine.ask('make_jaws', {seed: 2});
  engine.stages.clear();
  engine.ask('build', {voxel_size: 0.8});
  assert.ok(engine.stages.size >= 3, [...engine.stages].join());
});

test("times a query by a clock that is coarser than a browser's", async () => {
  const {hrtime} = process,
    step = 1e6; // the engine's clock in node, ns; browsers' step by 0.1 ms
  process.hrtime = () => {
    const [seconds, nanoseconds] = hrtime();
    return [seconds, nanoseconds - (nanoseconds % step)];
  };
  try {
    const coarse = await startEngine(process.env.IST_ENGINE);
    coarse.ask('make_jaws', {seed: 1});
    coarse.ask('build', {voxel_size: 2});
    const far = coarse.ask('collide', {pose: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -80, 1]}).microseconds;
    const near = coarse.ask('collide', {pose: poses[3]}).microseconds;
    assert.ok(far > 0 && far < near, `${far} and ${near} µs`);
  } finally {
    process.hrtime = hrtime;
  }
});

test('maps the occlusion as the command does', () => {
  engine.ask('make_jaws', {seed: 1});
  engine.ask('build', {voxel_size: 0.8});
  const asked = {pose: poses[3], preset: 'scan', reach: 2, unit: 'mm', frame: 'lps'};
  const map = engine.ask('occlusion', asked);
  const words = ['occlusion', upper, lower, '--move', '0,0,-0.6', '--unit', 'mm', '--frame', 'lps'];
  assert.deepEqual(withoutCommit(map.bite), withoutCommit(linesOf(ist(...words, '--json'))[1]));
  assert.equal(map.fixed.distances.length, map.bite.fixed.vertices);
  assert.equal(map.moving.distances.length, map.bite.moving.vertices);
  ist(...words, '-o', 'bite.glb');
  assert.ok(readFileSync(path.join(folder, 'bite.glb')).equals(engine.ask('save_glb', asked).bytes));
  assert.throws(() => engine.ask('occlusion', {...asked, preset: 'none'}), {code: 'argument-invalid'});
  assert.throws(() => engine.ask('occlusion', {...asked, reach: 0.01}), /reach/);
});

test('ticks as the query answers', () => {
  engine.ask('make_jaws', {seed: 1});
  engine.ask('build', {voxel_size: 0.8});
  for (const pose of poses) {
    const {line} = engine.ask('collide', {pose});
    const tick = engine.ask('tick', {pose, stiffness: 1});
    assert.equal(tick.touch, line.touch);
    assert.ok(tick.distance_lower <= line.distance_upper && line.distance_lower <= tick.distance_upper);
    assert.equal(tick.contacts.depths.length * 3, tick.contacts.positions.length);
    if (line.touch === 'no') continue;
    const twice = engine.ask('tick', {pose, stiffness: 2});
    twice.contacts.force.forEach((force, axis) => assert.equal(force, 2 * tick.contacts.force[axis]));
    assert.ok(tick.contacts.force[2] < 0, 'the lower jaw is pushed down');
  }
});

test('steps through a query front by front, down to its leaf pairs', () => {
  for (const [voxels, other] of [
    [0.8, null],
    [0.8, 1.6],
  ]) {
    engine.ask('make_jaws', {seed: 1});
    if (other !== null) {
      // a coarse tree beside a fine one
      ist('build', lower, '-o', 'coarse.ist', '--voxel-size', `${other}`, '--no-triangles');
      assert.equal(engine.open('moving', 'coarse.ist', readFileSync(path.join(folder, 'coarse.ist'))).rebuilds, false);
    }
    const trees = engine.ask('build', {voxel_size: voxels});
    assert.deepEqual([trees.fixed.voxel_size, trees.moving.voxel_size], [voxels, other ?? voxels]);
    for (const policy of ['simple', 'table', 'tight', 'slab']) {
      const {line} = engine.ask('collide', {pose: poses[3], policy});
      const {steps} = engine.ask('fronts', {pose: poses[3], policy});
      assert.equal(steps.at(-1).pairs, line.leaf_pairs);
      assert.equal(
        steps.reduce((sum, step) => sum + step.tests, 1),
        line.sphere_tests,
      );
      const front = engine.ask('front', {pose: poses[3], policy, step: steps.length - 1});
      assert.equal(front.fixed.length, line.leaf_pairs);
      assert.equal(front.fixed_level + front.moving_level, 0);
      const touched = engine.ask('touched', {pose: poses[3], policy, level: 0});
      assert.deepEqual(
        [...touched.moving],
        [...new Set(front.moving)].sort((a, b) => a - b),
      );
      const level = engine.ask('level', {role: 'moving', policy, level: 2});
      const inner = engine.ask('touched', {pose: poses[3], policy, level: 2});
      assert.ok(inner.moving.at(-1) < level.radii.length);
      assert.equal(level.normals?.length, policy === 'slab' ? level.centres.length : undefined);
      const before = steps.findIndex((step) => step.moving_level === 2 && step.fixed_level === 2);
      if (before < 0) continue;
      const at = engine.ask('front', {pose: poses[3], policy, step: before});
      assert.deepEqual(
        [...inner.moving],
        [...new Set(at.moving)].sort((a, b) => a - b),
      );
    }
  }
  assert.throws(() => engine.ask('front', {pose: poses[3], policy: 'slab', step: 99}), /steps/);
  assert.throws(() => engine.ask('level', {role: 'fixed', policy: 'slab', level: 60}), /levels/);
});

test('finds the first contact on the way', () => {
  engine.ask('make_jaws', {seed: 1});
  engine.ask('build', {voxel_size: 0.8});
  const found = engine.ask('first_contact', {from: poses[0], to: poses[4], tolerance: 1e-3});
  assert.equal(found.status, 'contact');
  assert.equal(engine.ask('tick', {pose: found.pose, stiffness: 1}).touch, 'yes');
  assert.ok(found.pose[14] > -3 && found.pose[14] < -0.5, `${found.pose[14]}`);
});

/** A tetrahedron whose apex is its highest point, or its lowest, as an OBJ file. */
function tetrahedron([x, y, z], up) {
  const base = [
    [-4, -3],
    [5, -2],
    [0, 6],
  ].map(([dx, dy]) => `v ${x + dx} ${y + dy} ${z - 10 * up}`);
  const faces = up > 0 ? ['1 2 4', '2 3 4', '3 1 4', '3 2 1'] : ['2 1 4', '3 2 4', '1 3 4', '1 2 3'];
  return Buffer.from([...base, `v ${x} ${y} ${z}`, ...faces.map((face) => `f ${face}`)].join('\n'));
}

test('says where the first contact is', () => {
  // An apex that rises into a flat face, 3 above it.
  engine.open('fixed', 'above.obj', Buffer.from('v -50 -50 8\nv 50 -50 8\nv 0 70 8\nv 0 0 30\nf 3 2 1\nf 1 2 4\nf 2 3 4\nf 3 1 4'));
  engine.open('moving', 'below.obj', tetrahedron([1.25, -2.5, 5], 1));
  engine.ask('build', {voxel_size: 1});
  const at = (dz) => [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, dz, 1];
  const found = engine.ask('first_contact', {from: at(-2), to: at(6), tolerance: 1e-6});
  assert.equal(found.status, 'contact');
  // At the end of the interval the apex is just behind the face.
  [1.25, -2.5, 8].forEach((value, axis) => assert.ok(Math.abs(found.point[axis] - value) < 1e-3, `${found.point}`));
  assert.equal(engine.ask('first_contact', {from: at(-9), to: at(-5), tolerance: 1e-6}).point, null);
});

test('says how bodies face each other, and swaps them', () => {
  engine.ask('make_jaws', {seed: 1});
  const bite = poses.at(-2);
  const facing = engine.ask('facing', {pose: bite, frame: ''});
  assert.deepEqual(facing, {known: true, towards: [0, 0, -1], front: facing.front, upper: 'fixed'});
  [0, -1, 0].forEach((value, axis) => assert.ok(Math.abs(facing.front[axis] - value) < 1e-12, 'the narrower end is in front'));
  engine.ask('build', {voxel_size: 2});
  const {line} = engine.ask('collide', {pose: bite});
  engine.ask('swap', {});
  assert.throws(() => engine.ask('collide', {pose: bite}), /not built/);
  const back = [...bite.slice(0, 14), -bite[14], 1];
  const other = engine.ask('facing', {pose: back, frame: ''});
  assert.deepEqual([other.towards, other.upper], [[0, 0, 1], 'moving']);
  engine.ask('build', {voxel_size: 2});
  const turned = engine.ask('collide', {pose: back}).line;
  assert.ok(turned.depth_lower <= line.depth_upper && line.depth_lower <= turned.depth_upper, 'as deep the other way round');
  // Far from each other, and without triangles, nothing is told of roles.
  assert.equal(engine.ask('facing', {pose: [...bite.slice(0, 14), -300, 1], frame: ''}).known, false);
  ist('build', lower, '-o', 'none.ist', '--voxel-size', '2', '--no-triangles');
  engine.open('moving', 'none.ist', readFileSync(path.join(folder, 'none.ist')));
  assert.deepEqual(engine.ask('facing', {pose: bite, frame: ''}), {known: false});
});

/** An engine whose memory ends: `limit` says at how many bytes, and `bytes` how many there are. */
async function short(use) {
  const {grow} = WebAssembly.Memory.prototype;
  const memory = {bytes: 0, limit: Infinity};
  WebAssembly.Memory.prototype.grow = function (pages) {
    if (this.buffer.byteLength + pages * 65536 > memory.limit) throw new RangeError('Maximum memory size exceeded');
    const before = grow.call(this, pages);
    memory.bytes = this.buffer.byteLength;
    return before;
  };
  try {
    await use(await startEngine(process.env.IST_ENGINE), memory);
  } finally {
    WebAssembly.Memory.prototype.grow = grow;
  }
}

/** Calls `what` with more and more memory until it fits. After each end it calls `check`, which may take all the memory it needs. */
function untilItFits(memory, what, check) {
  let ended = 0;
  for (let limit = memory.bytes; ; limit = Math.max(limit, memory.bytes) + 2e6) {
    memory.limit = limit;
    try {
      what();
      return ended;
    } catch (error) {
      assert.equal(error.code, 'memory-limit');
      assert.match(error.message, /memory is full/);
    }
    ended += 1;
    memory.limit = Infinity;
    check();
  }
}

test('says so where memory ends while a tree is built, and keeps the trees before', () =>
  short((small, memory) => {
    small.ask('make_jaws', {seed: 1});
    small.ask('build', {voxel_size: 2});
    const {line} = small.ask('collide', {pose: poses[3]});
    const tree = Buffer.from(small.ask('save_body', {role: 'fixed'}).bytes);
    // It ends at the first body, then at the second.
    const ended = untilItFits(
      memory,
      () => small.ask('build', {voxel_size: 0.8}),
      () => {
        assert.deepEqual(answerOf(small.ask('collide', {pose: poses[3]}).line), answerOf(line));
        assert.ok(tree.equals(small.ask('save_body', {role: 'fixed'}).bytes), 'the tree is the one that answers');
      },
    );
    assert.ok(ended > 5, `${ended} times`);
    assert.equal(small.ask('collide', {pose: poses[3]}).line.voxel_size[0], 0.8);
  }));

test('says so where memory ends while a body is read or described, and keeps the body before', () =>
  short((small, memory) => {
    ist('build', lower, '-o', 'bare.ist', '--voxel-size', '0.4', '--no-triangles');
    const bare = readFileSync(path.join(folder, 'bare.ist'));
    small.ask('make_jaws', {seed: 1});
    small.ask('build', {voxel_size: 2});
    const {header, line} = small.ask('collide', {pose: poses[3]});
    const ended = untilItFits(
      memory,
      () => small.open('moving', 'bare.ist', bare),
      () => {
        const again = small.ask('collide', {pose: poses[3]});
        assert.deepEqual([again.header, answerOf(again.line)], [header, answerOf(line)]);
      },
    );
    assert.ok(ended > 5, `${ended} times`);
    assert.throws(() => small.ask('collide', {pose: poses[3]}), /not built/);
  }));

test("refuses bad files with the command's sentence, and goes on", () => {
  engine.ask('make_jaws', {seed: 1});
  const bad = [
    ['half.stl', readFileSync(path.join(folder, upper)).subarray(0, 5000), 'mesh-truncated', /copy or export it again/],
    ['text.obj', Buffer.from('v 0 0 0\nv 1 0 nan\n'), 'mesh-not-finite', /repair the mesh/],
    ['empty.ply', Buffer.alloc(0), 'mesh-empty', /export the mesh again/],
    ['points.obj', Buffer.from('v 0 0 0\nv 1 0 0\nv 0 1 0\n'), 'mesh-points-only', /export the surface as polygons/],
    ['tree.ist', Buffer.from('ISTTREE1 nothing'), 'not-a-mesh', /convert the mesh/],
  ];
  for (const [name, bytes, code, whatToDo] of bad) {
    assert.throws(
      () => engine.open('fixed', name, bytes),
      (error) => {
        assert.ok(error.message.startsWith(`fixed/${name}: `), error.message);
        assert.equal(error.code, code);
        assert.match(error.message, whatToDo);
        return true;
      },
    );
  }
  for (const pose of [[1], Array(16).fill(null), [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1]]) {
    engine.ask('build', {voxel_size: 2});
    assert.throws(() => engine.ask('tick', {pose, stiffness: 1}), /pose/);
  }
  assert.throws(() => engine.ask('build', {voxel_size: 1e-4}), {code: /memory-limit|voxel-size-too-small/});
  assert.equal(engine.ask('tick', {pose: poses[4], stiffness: 1}).touch, 'yes');
});
