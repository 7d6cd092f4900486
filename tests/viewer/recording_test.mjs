import assert from 'node:assert/strict';
import {test} from 'node:test';

import {identity, multiply, transformed, translation} from '../../src/viewer/page/pose.js';
import {placeAt, relative, spansOf} from '../../src/viewer/page/recording/placed_bodies.js';
import {indexAt, toolPath} from '../../src/viewer/page/recording/playback.js';
import {arrowsOf} from '../../src/viewer/page/recording/points.js';
import {parseRecording, poseOfRow, recordingSteps} from '../../src/viewer/page/recording/recording.js';
import {placedByScene, sceneBodies} from '../../src/viewer/page/recording/scene_bodies.js';

const header = {recording: 3, ist: '1.2.3', commit: 'c', dt: 0.001, unit: 0.001, bodies: [{name: 'fixed'}, {name: 'held'}], scene: ''};
const row = (z) => [0, 0, z, 1, 0, 0, 0, 1, 0, 0, 0, 1];
const tick = (number, more = {}) => ({
  tick: number,
  dt: 0.001,
  device: row(0),
  tool: row(0.001 * number),
  wrench: [3, 0, 4, 0, 0, 0],
  contacts: 5,
  held: false,
  fault: false,
  steps: 0,
  halved: false,
  points: [],
  late_microseconds: 1,
  microseconds: 40,
  ...more,
});
const point = {position: [0.001, 0, 0], normal: [0, 0, 1], force: [0, 3, 4], gap: 5e-6, triangles: [7, 9], bodies: [0, 1]};
const text = (...lines) => lines.map((line) => (typeof line === 'string' ? line : JSON.stringify(line))).join('\n') + '\n';

test('ticks are read, with their force and time', () => {
  const {ticks, dt, cutOff} = parseRecording(text(header, tick(0), tick(1)));
  assert.equal(ticks.length, 2);
  assert.equal(dt, 0.001);
  assert.equal(cutOff, null);
  assert.equal(ticks[1].force, 5);
  assert.equal(ticks[1].time, 0.001);
  assert.deepEqual(ticks[1].tool, translation([0, 0, 0.001]));
});

test('ticks have contact points, steps, and what became of them', () => {
  const strong = {...point, force: [0, -6, 8]};
  const {ticks, byPoints, strongest} = parseRecording(
    text(header, tick(0, {steps: 1, points: [point]}), tick(1, {steps: 3, halved: true, points: [point, strong]}), tick(2, {held: true})),
  );
  assert.deepEqual(
    ticks.map(({steps, halved, held, points}) => [steps, halved, held, points.length]),
    [
      [1, false, false, 1],
      [3, true, false, 2],
      [0, false, true, 0],
    ],
  );
  assert.deepEqual(ticks[1].points, [point, strong]);
  assert.deepEqual([byPoints, strongest], [true, 10]);
  const springs = parseRecording(text(header, tick(0), tick(1)));
  assert.deepEqual([springs.byPoints, springs.strongest], [false, 0]);
});

test('arrows stand at the points, in units and axes of the fixed body, as long as their force', () => {
  // The fixed body lies 2 mm along x, and its x is the scene's y.
  const fixed = [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0.002, 0, 0, 1];
  const [first, second] = arrowsOf([point, {...point, force: [0, 0, 10]}], fixed, 0.001, 10);
  [0, 1, 0].forEach((value, axis) => assert.ok(Math.abs(first.at[axis] - value) < 1e-9, `${first.at}`));
  [3, 0, 4].forEach((value, axis) => assert.ok(Math.abs(first.force[axis] - value) < 1e-12, `${first.force}`));
  assert.deepEqual([first.part, second.part], [0.5, 1]);
  assert.equal(arrowsOf([{...point, force: [0, 0, 0]}], fixed, 0.001, 0)[0].part, 0);
});

test('a row is a position, and a rotation column by column', () => {
  assert.deepEqual(transformed(poseOfRow([1, 2, 3, 0, 1, 0, -1, 0, 0, 0, 0, 1]), [1, 0, 0]), [1, 3, 3]);
});

test('ticks after missing ones, and those longer than a period, are late', () => {
  const {ticks} = parseRecording(text(header, tick(0), tick(1), tick(4), tick(5, {microseconds: 1200})));
  assert.deepEqual(
    ticks.map(({late}) => late),
    [false, false, true, true],
  );
});

test('a tick without a device keeps its place', () => {
  const {ticks} = parseRecording(text(header, tick(0), tick(1, {device: null, tool: null, contacts: null, wrench: [null, 0, 0, 0, 0, 0]})));
  assert.equal(ticks[1].device, null);
  assert.equal(ticks[1].contacts, null);
  assert.equal(ticks[1].force, 0);
  assert.deepEqual(ticks[1].tool, ticks[0].tool);
});

test('what is no recording of this version is refused, with what to do', () => {
  assert.throws(() => parseRecording(''), /empty.*ist run/);
  assert.throws(() => parseRecording('tick,dt,device_known\n0,0.001,1\n'), /is CSV.*record JSON lines/);
  assert.throws(() => parseRecording('solid jaw\n'), /no recording.*Record one/);
  assert.throws(() => parseRecording('{"ist": 1}\n'), /no recording version/);
  assert.throws(() => parseRecording(text(tick(0))), /version 1.*record the scene again/);
  assert.throws(() => parseRecording(text({...header, recording: 4}, tick(0))), /of version 4.*open it in a page/);
  assert.throws(() => parseRecording(text({...header, recording: 2}, tick(0))), /of version 2.*record the scene again/);
  assert.throws(() => parseRecording(text(header)), /no ticks/);
  assert.throws(() => parseRecording(text(header, '{"tick": 0', tick(1))), /Line 2 .*damaged/);
  assert.throws(() => parseRecording(text(header, tick(0), tick(1, {tool: [1, 2]}))), /Line 3 .*no tick/);
  for (const points of [null, [1], [{...point, force: [1, 2]}], [{...point, gap: null}], [{...point, bodies: undefined}]]) {
    assert.throws(() => parseRecording(text(header, tick(0, {points}))), /Line 2 .*no tick: it needs .* and points/);
  }
  for (const number of [0, 1]) {
    assert.throws(() => parseRecording(text(header, tick(0), tick(1), tick(number))), /Line 4 .*after tick 1\. Record/);
  }
  for (const wrong of [{dt: 0}, {dt: null}, {unit: 'mm'}, {bodies: null}, {bodies: [{}]}, {bodies: [null]}]) {
    assert.throws(() => parseRecording(text({...header, ...wrong}, tick(0))), /header .*damaged: it needs dt and unit .*Record/);
  }
});

test('blank lines are passed over, and counted', () => {
  const {ticks} = parseRecording(`\n${text(header)}\n\n${text(tick(0), tick(1))}\n \n`);
  assert.equal(ticks.length, 2);
  assert.throws(() => parseRecording(`\n${text(header)}\n${text(tick(0))}{"tick"\n${text(tick(1))}`), /Line 5 /);
});

test('a long one is read by steps, and tells how far it is', () => {
  const whole = text(header, ...Array.from({length: 3000}, (_, at) => tick(at)));
  const parts = [];
  const steps = recordingSteps(whole);
  let step = steps.next();
  for (; !step.done; step = steps.next()) parts.push(step.value);
  assert.ok(parts.length >= 10 && parts.every((part, at) => part > (parts[at - 1] ?? 0) && part < 1), parts.join());
  assert.deepEqual(step.value, parseRecording(whole));
});

test('a recording that is cut off plays to there', () => {
  const {ticks, cutOff} = parseRecording(text(header, tick(0), tick(1)) + '{"tick": 2, "dt"');
  assert.equal(ticks.length, 2);
  assert.match(cutOff, /cut off in line 4/);
});

test('a held body goes with the tool; what is taken goes on with it from where it was', () => {
  const recording = parseRecording(
    text(
      header,
      tick(0),
      tick(1),
      {tick: 2, attach: 'piece', status: 'done'},
      tick(2),
      tick(3),
      {tick: 4, release: 'piece', status: 'touching'},
      {tick: 4, release: 'piece', status: 'done'},
      tick(4),
    ),
  );
  const bodies = [
    {name: 'held', held: true, pose: translation([0, 0, -0.5]), in_tool: translation([0, 0, -0.5])},
    {name: 'piece', held: false, pose: translation([1, 0, 0])},
  ];
  const [held, piece] = spansOf(bodies, recording);
  const z = (spans, at) => placeAt(spans, at, recording.ticks[at].tool)[14];
  assert.ok(Math.abs(z(held, 3) + 0.497) < 1e-12);
  assert.deepEqual(
    [0, 1, 2, 3, 4].map((at) => Number(z(piece, at).toFixed(9))),
    [0, 0, 0.001, 0.002, 0.002],
  );
});

test('poses in metres become mesh units of the fixed body', () => {
  assert.deepEqual(
    relative(translation([0, 0, 0.01]), translation([0, 0, 0.012]), 0.001).map((value) => Number(value.toFixed(9))),
    translation([0, 0, 2]),
  );
});

test('a scene of two bodies places them, the tool at the middle of the held box or at its origin', () => {
  const scene =
    'unit = "mm"\n[fixed]\nshape = "upper jaw"\nseed = 3\nvoxel_size = 0.5\n[held]\nshape = "lower jaw"\nseed = 3\nvoxel_size = 0.5\n' +
    'translation = [0, 0, -5]  # open\n[effects.contact]\n';
  const found = sceneBodies({...header, scene});
  assert.equal(found.held.shape, 'lower jaw');
  assert.equal(found.fixed.seed, 3);
  const facts = {info: {box_min: [-10, 0, 0], box_max: [90, 20, 30]}};
  const [fixed, held] = placedByScene(found, {fixed: facts, moving: facts}, header);
  assert.deepEqual(fixed.pose, [...identity]);
  assert.deepEqual(
    held.in_tool.map((value) => Number(value.toFixed(9))),
    translation([-0.04, -0.01, -0.015]),
  );
  const tool = translation([0.04, 0.01, 0.01]);
  multiply(tool, held.in_tool).forEach((value, at) => assert.ok(Math.abs(value - held.pose[at]) < 1e-12));
  const named = sceneBodies({
    ...header,
    scene: scene.replace('[0, 0, -5]', '[0, 0, -5]\norigin = [1, -2, 3]').replaceAll('voxel_size = 0.5\n', ''),
  });
  assert.deepEqual(
    placedByScene(named, {fixed: facts, moving: facts}, header)[1].in_tool.map((value) => Number(value.toFixed(9))),
    translation([-0.001, 0.002, -0.003]),
  );
  for (const other of ['[[fixed]]\n[[fixed]]\n[held]\n', '[fixed]\nfile = "a.ist"\n[held]\nfile = "b.stl"\n']) {
    assert.equal(sceneBodies({...header, scene: other}), null);
  }
});

test('the clock finds the tick of a time', () => {
  const {ticks} = parseRecording(text(header, tick(0), tick(1), tick(5)));
  assert.deepEqual(
    [-1, 0, 0.0009, 0.0011, 0.004, 0.005, 9].map((time) => indexAt(ticks, time)),
    [0, 0, 0, 1, 1, 2, 2],
  );
});

test('the way of the tool has its middle and its size, of an hour too', () => {
  const {points, middle, size} = toolPath(
    [0, 0.03].map((z) => ({tool: translation([0.001, 0, z])})),
    1000,
  );
  assert.deepEqual(points, [1, 0, 0, 1, 0, 30]);
  assert.deepEqual([middle, size], [[1, 0, 15], 15]);
  assert.equal(toolPath([{tool: [...identity]}], 1000).size, 1);
  const hour = Array.from({length: 400_000}, (_, at) => ({tool: translation([0, 0, at / 1e6])}));
  assert.ok(Math.abs(toolPath(hour, 100).size - 20) < 1e-3);
});
