import assert from 'node:assert/strict';
import {test} from 'node:test';

import {meshBytes} from '../../src/viewer/page/scene_files.js';

globalThis.self ??= globalThis; // as in a browser

/** One triangle (0 0 0, 1 0 0, 0 2 0), as indexed floats. */
const triangle = new Uint8Array([...new Uint8Array(new Float32Array([0, 0, 0, 1, 0, 0, 0, 2, 0]).buffer), 0, 1, 2, 0]);
const json = (changes = {}) => ({
  asset: {version: '2.0'},
  scene: 0,
  scenes: [{nodes: [0]}],
  nodes: [{mesh: 0}],
  meshes: [{primitives: [{attributes: {POSITION: 0}, indices: 1, material: 7}]}],
  accessors: [
    {bufferView: 0, componentType: 5126, count: 3, type: 'VEC3', min: [0, 0, 0], max: [1, 2, 0]},
    {bufferView: 1, componentType: 5121, count: 3, type: 'SCALAR'},
  ],
  bufferViews: [
    {buffer: 0, byteLength: 36},
    {buffer: 0, byteOffset: 36, byteLength: 3},
  ],
  buffers: [{byteLength: 40, uri: `data:application/octet-stream;base64,${Buffer.from(triangle).toString('base64')}`}],
  ...changes,
});
const text = (content) => new TextEncoder().encode(JSON.stringify(content)).buffer;
function glb(content) {
  const words = new TextEncoder().encode(JSON.stringify(content).padEnd(Math.ceil(JSON.stringify(content).length / 4) * 4));
  const bytes = new DataView(new ArrayBuffer(28 + words.length + triangle.length));
  const [head, body] = [12, 20 + words.length];
  new Uint8Array(bytes.buffer).set(new TextEncoder().encode('glTF'));
  [2, bytes.byteLength].forEach((value, i) => bytes.setUint32(4 + 4 * i, value, true));
  [words.length, 0x4e4f534a].forEach((value, i) => bytes.setUint32(head + 4 * i, value, true));
  [triangle.length, 0x004e4942].forEach((value, i) => bytes.setUint32(body + 4 * i, value, true));
  new Uint8Array(bytes.buffer).set(words, 20);
  new Uint8Array(bytes.buffer).set(triangle, body + 8);
  return bytes.buffer;
}

/** The corners of a PLY's triangles. */
function cornersOf(bytes) {
  const [header] = /^ply[^]*end_header\n/.exec(new TextDecoder('latin1').decode(bytes)),
    view = new DataView(bytes, header.length);
  const [points, faces] = [...header.matchAll(/element \w+ (\d+)/g)].map(([, number]) => Number(number));
  assert.equal(view.byteLength, 24 * points + 13 * faces);
  const point = (i) => [0, 8, 16].map((at) => view.getFloat64(24 * i + at, true));
  return Array.from({length: faces}, (_, face) => [1, 5, 9].map((at) => point(view.getUint32(24 * points + 13 * face + at, true))));
}

test('a glTF becomes a PLY in metres, where its nodes place its meshes', async () => {
  const plain = await meshBytes('a.gltf', text(json()));
  assert.equal(plain.unit, 'm');
  assert.deepEqual(cornersOf(plain.bytes), [[[0, 0, 0], [1, 0, 0], [0, 2, 0]]]); // prettier-ignore
  const scaled = {
    nodes: [
      {children: [1], translation: [10, 0, 0]},
      {mesh: 0, scale: [3, 1, 1]},
    ],
  };
  const placed = await meshBytes('a.gltf', text(json(scaled)));
  assert.deepEqual(cornersOf(placed.bytes), [[[10, 0, 0], [13, 0, 0], [10, 2, 0]]]); // prettier-ignore
});

test('a unit that contradicts the file is refused', async () => {
  assert.equal((await meshBytes('a.gltf', text(json()), 'm')).unit, 'm');
  await assert.rejects(meshBytes('a.gltf', text(json()), 'mm'), /a\.gltf: the file says metres, and millimetres are chosen/);
});

test('a rotation of four digits is a rotation', async () => {
  const half = Math.SQRT1_2.toFixed(4);
  const {bytes} = await meshBytes('a.gltf', text(json({nodes: [{mesh: 0, rotation: [0, 0, Number(half), Number(half)]}]})));
  const [, x, y] = cornersOf(bytes)[0];
  assert.ok(Math.hypot(x[0], x[1] - 1) < 1e-12 && Math.hypot(y[0] + 2, y[1]) < 1e-12, `${x}; ${y}`);
});

test('a mirror image is wound the other way', async () => {
  const {bytes} = await meshBytes('a.gltf', text(json({nodes: [{mesh: 0, scale: [-1, 1, 1]}]})));
  assert.deepEqual(cornersOf(bytes), [[[0, 0, 0], [0, 2, 0], [-1, 0, 0]]].map((face) => face.map((p) => p.map((x) => x + 0)))); // prettier-ignore
});

test('a GLB holds its own buffer', async () => {
  const {bytes} = await meshBytes('a.glb', glb(json({buffers: [{byteLength: 40}]})));
  assert.deepEqual(cornersOf(bytes), [[[0, 0, 0], [1, 0, 0], [0, 2, 0]]]); // prettier-ignore
});

test('what the page cannot read is refused with the remedy', async () => {
  const refused = async (changes, words) => {
    await assert.rejects(meshBytes('a.gltf', text(json(changes))), (error) => {
      assert.match(error.message, /^a\.gltf: .*\. Export the mesh as STL, PLY or OBJ, or open it by the command, ist\.$/);
      assert.match(error.message, words);
      return true;
    });
  };
  await refused({buffers: [{byteLength: 40, uri: 'a.bin'}]}, /export it as \.glb/);
  await refused({extensionsUsed: ['KHR_draco_mesh_compression'], extensionsRequired: ['KHR_draco_mesh_compression']}, /KHR_draco/);
  await refused({asset: {version: '1.0'}}, /2\.0/);
  await refused({meshes: [{primitives: [{attributes: {POSITION: 0}, indices: 1, mode: 1}]}]}, /no triangle/);
  await refused({skins: [{joints: [0]}], nodes: [{mesh: 0, skin: 0}]}, /skin/);
  await refused({nodes: [{mesh: 0, rotation: [0, 0, 0, 1.1]}]}, /rotation has the length 1\.1/);
  await refused({nodes: [{mesh: 0, extensions: {EXT_mesh_gpu_instancing: {}}}]}, /EXT_mesh_gpu_instancing/);
  await refused({nodes: [{mesh: 0, children: [1]}, {children: [0]}]}, /circle of nodes/); // prettier-ignore
  await refused({nodes: [{children: [1, 1]}, {mesh: 0}]}, /two parents/); // prettier-ignore
  const broken = json();
  broken.accessors[0].count = 2;
  await refused(broken, /vertex 2, but there are 2/);
  await assert.rejects(meshBytes('a.gltf', new TextEncoder().encode('{').buffer), /^Error: a\.gltf: /);
});

test('extensions of looks alone do not matter', async () => {
  const looks = {extensionsUsed: ['KHR_materials_unlit'], extensionsRequired: ['KHR_materials_unlit']};
  assert.equal(cornersOf((await meshBytes('a.gltf', text(json(looks)))).bytes).length, 1);
});

test('other files stay as they are', async () => {
  const {buffer} = new TextEncoder().encode('solid');
  assert.deepEqual(await meshBytes('a.stl', buffer), {bytes: buffer, unit: undefined});
  assert.equal((await meshBytes('a.stl', buffer, 'inch')).unit, 'inch');
});
