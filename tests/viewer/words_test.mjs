import assert from 'node:assert/strict';
import {test} from 'node:test';

import {depthWords, infoSentences, interval, nearestPoints, nearestWords, short} from '../../src/viewer/page/words.js';
import {wrenchAtMiddle} from '../../src/viewer/page/wrench.js';

test('numbers are short, and tell their size', () => {
  assert.deepEqual(
    [0, 1.38654, -0.6, 12345.6, 1e-7, 2e9, NaN].map((value) => short(value)),
    ['0', '1.387', '−0.6', '12,346', '1.00e−7', '2.00e9', '–'],
  );
  assert.equal(interval(0.284, 0.2949, 'mm'), '0.284 to 0.2949 mm');
  assert.equal(interval(0.28400001, 0.28400004, 'mm'), '0.284 mm');
  assert.equal(interval(null, null, 'mm'), 'not known');
});

test('nearest points are two, one of bodies that touch, or not known', () => {
  const line = {nearest_fixed: [1, -2.34567, 3], nearest_moving: [1, -2.34567, 3.5], distance_lower: 0.49, distance_upper: 0.5};
  assert.deepEqual(nearestPoints(line), [line.nearest_fixed, line.nearest_moving]);
  assert.equal(nearestWords(line), '(1, −2.346, 3) and (1, −2.346, 3.5)');
  assert.equal(nearestWords({...line, nearest_moving: line.nearest_fixed, distance_upper: 0}), 'both at (1, −2.346, 3)');
  assert.equal(nearestPoints({...line, nearest_fixed: null}), null);
  assert.equal(nearestWords({nearest_fixed: null, nearest_moving: null, distance_upper: 1}), 'not known');
});

test('a depth is an interval, of open scans a lower bound, and 0 where they are apart', () => {
  const open = {depth_lower: null, depth_upper: null, touch: 'yes', inside: 'none', self_intersecting: false, depth_at_vertices: 1.0539};
  for (const [line, words] of [
    [{depth_lower: 0.284, depth_upper: 0.2949, depth_at_vertices: 0.28, touch: 'yes'}, '0.284 to 0.2949 mm'],
    [{depth_lower: 0, depth_upper: 0, depth_at_vertices: 0, touch: 'no'}, '0 mm'],
    [open, '≥ 1.05 mm (open scans)'],
    [{...open, depth_at_vertices: 0}, 'not known'],
    [{...open, touch: 'no', inside: null}, '0, or ≥ 1.05 mm (open scans)'],
    [{...open, touch: 'no', depth_at_vertices: 0}, '0 mm'],
    [{...open, touch: 'no', inside: null, depth_at_vertices: null}, '0 mm'],
    [{...open, touch: 'no', inside: 'moving', depth_at_vertices: null}, 'not known'],
    // Trees without triangles: one may lie in the other.
    [{...open, touch: 'no', inside: null, self_intersecting: null, depth_at_vertices: null}, 'not known'],
    [{...open, touch: 'no', self_intersecting: null, depth_at_vertices: null}, '0 mm'],
    [{...open, touch: 'near', depth_at_vertices: null}, 'not known'],
    [{...open, touch: 'unknown', depth_at_vertices: 0}, 'not known'],
  ])
    assert.equal(depthWords(line, 'mm'), words);
});

test('sentences describe a body', () => {
  const mesh = {
    kind: 'mesh',
    triangles: 12,
    vertices: 8,
    components: 1,
    boundary_edges: 4,
    extent: [1, 2, 3],
    closed: false,
    consistent: true,
    unit: null,
  };
  assert.deepEqual(infoSentences(mesh), [
    'A mesh of 12 triangles and 8 vertices, 1 component.',
    'Extent 1 × 2 × 3; the file names no unit, so millimetres are assumed.',
    'Open (4 border edges), wound consistently: its inside is assumed from the winding.',
  ]);
  assert.equal(infoSentences(mesh, 'inch')[1], 'Extent 1 × 2 × 3; the file names no unit, so inches are assumed.');
  const tree = {kind: 'tree', triangles: false, voxels: 9, voxel_size: 0.5, extent: [1, 2, 3], closed: null, unit: 'mm'};
  assert.match(infoSentences(tree).join(' '), /A tree of 9 voxels of 0.5, without triangles.* Extent 1 × 2 × 3 mm\.$/);
  assert.equal(
    infoSentences({...tree, triangles: true, voxels: null, voxel_size: null})[0],
    'A tree of triangles without voxels: the page builds its own tree.',
  );
});

test("a wrench about the contacts' middle does the same as about another point", () => {
  const contacts = {
    positions: [0, 0, 0, 2, 0, 0],
    normals: [],
    depths: [],
    weights: [1, 1],
    force: [0, 0, 3],
    torque: [0, -3, 0],
    about: [0, 0, 0],
  };
  assert.deepEqual(wrenchAtMiddle(contacts), {at: [1, 0, 0], force: [0, 0, 3], torque: [0, 0, 0]});
});
