/**
 * Reads glTF 2.0 and 3MF by the loaders of three.js, and gives their triangles to the engine as a PLY. The command
 * reads both by another program, which a page cannot start.
 */

import {GLTFLoader} from 'three/addons/loaders/GLTFLoader.js';
import {ThreeMFLoader} from 'three/addons/loaders/3MFLoader.js';
import {unzipSync} from 'three/addons/libs/fflate.module.js';
import {Matrix4, Vector3} from 'three';

import {unitNames} from './words.js';

/** @typedef {import('./protocol.js').Unit} Unit */
/** @typedef {{bytes: ArrayBuffer, unit?: Unit}} MeshBytes */
/** @typedef {{unit: Unit, scale: number}} Length  a length times the scale is in the unit */
/** @typedef {{asset?: {version?: string}, scenes?: {nodes?: number[]}[], scene?: number, extensionsRequired?: string[], buffers?: {uri?: string}[],
 *   bufferViews?: {buffer: number, byteOffset?: number, byteLength: number}[], meshes?: {primitives?: {material?: number, targets?: unknown[]}[]}[],
 *   nodes?: {mesh?: number, skin?: number, children?: number[], rotation?: number[], extensions?: Record<string, unknown>}[],
 *   animations?: unknown[], cameras?: unknown[], textures?: unknown[]}} Gltf */

/** Extensions of glTF that move no vertex, or that the loader knows. */
const harmless = /^(KHR_materials_|KHR_texture_|EXT_texture_|KHR_lights_|KHR_xmp|KHR_mesh_quantization$|KHR_animation_pointer$)/;
/** Bytes of all parts of a 3MF. */
const mostUnpacked = 1e9;
/** Of 3MF; the engine has no centimetres and no feet. @type {Record<string, Length>} */
const lengths = {
  micron: {unit: 'µm', scale: 1},
  millimeter: {unit: 'mm', scale: 1},
  centimeter: {unit: 'mm', scale: 10},
  inch: {unit: 'inch', scale: 1},
  foot: {unit: 'inch', scale: 12},
  meter: {unit: 'm', scale: 1},
};

/**
 * Gives the bytes that the engine reads, and their unit: those of the file, or of a PLY in the unit that the file states.
 * @param {string} name
 * @param {ArrayBuffer} bytes
 * @param {Unit} [told]  by people, who must not contradict the file
 * @returns {Promise<MeshBytes>}
 */
export async function meshBytes(name, bytes, told) {
  const {unit, ...read} = await converted(name, bytes);
  if (told && unit && told !== unit) {
    throw new Error(
      `${name}: the file says ${unitNames[unit]}, and ${unitNames[told]} are chosen as the unit of the files you open: choose "as the file says".`,
    );
  }
  return {...read, unit: told ?? unit};
}

/**
 * @param {string} name
 * @param {ArrayBuffer} bytes
 * @returns {Promise<MeshBytes>}
 */
async function converted(name, bytes) {
  const begin = new TextDecoder('latin1').decode(new Uint8Array(bytes, 0, Math.min(bytes.byteLength, 256)));
  try {
    if (begin.startsWith('glTF') || /^(\xEF\xBB\xBF)?\s*\{/.test(begin)) return await gltfBytes(bytes);
    if (begin.startsWith('PK\x03\x04')) return threeMfBytes(bytes);
  } catch (error) {
    const cause = error instanceof Error ? error.message.replace(/^THREE\.\w+: /, '') : String(error);
    throw new Error(`${name}: ${cause.replace(/\.$/, '')}. Export the mesh as STL, PLY or OBJ, or open it by the command, ist.`);
  }
  return {bytes};
}

/**
 * @param {ArrayBuffer} bytes
 * @returns {Promise<MeshBytes>}
 */
async function gltfBytes(bytes) {
  const loader = new GLTFLoader();
  loader.register((parser) => geometryAlone(parser.json));
  const {scene} = await loader.parseAsync(bytes, '');
  if (!scene) throw new Error('the glTF has no scene');
  return {bytes: ply(scene, 1), unit: 'm'};
}

/**
 * Leaves out what needs a picture or moves later, and decodes buffers without a request.
 * @param {Gltf} json
 */
function geometryAlone(json) {
  const unknown = (json.extensionsRequired ?? []).filter((extension) => !harmless.test(extension));
  if (unknown.length > 0) throw new Error(`the extension ${unknown[0]} is required, and not supported`);
  for (const {primitives = []} of json.meshes ?? []) {
    for (const primitive of primitives) {
      if (primitive.targets) throw new Error('morph targets move its vertices');
      delete primitive.material;
    }
  }
  checkNodes(json);
  Object.assign(json, {animations: [], cameras: [], textures: []});
  return {
    name: 'IST_geometry_alone',
    /** @param {number} index */
    loadBufferView(index) {
      const view = json.bufferViews?.[index],
        uri = json.buffers?.[view?.buffer ?? -1]?.uri;
      if (!view || uri === undefined) return null; // the loader has the buffer of a .glb
      const data = /^data:[^,]*;base64,(.*)$/s.exec(uri);
      if (!data) throw new Error('its buffers are in other files, and a page gets one file: export it as .glb');
      const whole = Uint8Array.from(atob(data[1]), (byte) => byte.charCodeAt(0)),
        begin = view.byteOffset ?? 0;
      return Promise.resolve(whole.buffer.slice(begin, begin + view.byteLength));
    },
  };
}

/**
 * Refuses nodes that the loader would place wrongly, or wait for without an end. A rotation may be rounded to four digits.
 * @param {Gltf} json
 */
function checkNodes({nodes = [], scenes = []}) {
  const below = new Set(scenes.flatMap((scene) => scene.nodes ?? []));
  for (const node of nodes) {
    if (node.mesh !== undefined && node.skin !== undefined) throw new Error('a skin bends its mesh');
    if (node.extensions?.EXT_mesh_gpu_instancing)
      throw new Error('a node repeats its mesh by EXT_mesh_gpu_instancing, which is not supported');
    for (const child of node.children ?? []) {
      if (below.has(child)) throw new Error(`node ${child} has two parents, or is in a circle of nodes`);
      below.add(child);
    }
    if (!node.rotation) continue;
    const length = Math.hypot(...node.rotation);
    if (!(Math.abs(length - 1) < 1e-3)) throw new Error(`a rotation has the length ${length}, not 1`);
    node.rotation = node.rotation.map((value) => value / length);
  }
}

/**
 * @param {ArrayBuffer} bytes
 * @returns {MeshBytes}
 */
function threeMfBytes(bytes) {
  let total = 0;
  const filter = (/** @type {{name: string, originalSize: number}} */ {name, originalSize}) => {
    total += originalSize;
    if (total > mostUnpacked) throw new Error('its parts unpack to more than 1 GB');
    return /\.(model|config|rels)$/.test(name);
  };
  const {unit, scale} = lengthOf(unzipSync(new Uint8Array(bytes), {filter}));
  return {bytes: ply(new ThreeMFLoader().parse(bytes), scale), unit};
}

/**
 * Checks that the loader reads all of a 3MF's geometry.
 * @param {Record<string, Uint8Array>} parts
 * @returns {Length}
 */
function lengthOf(parts) {
  /** @param {string} name */
  const text = (name) => (parts[name] ? new TextDecoder().decode(parts[name]) : '');
  const target = /<Relationship\b[^>]*\bTarget="\/?([^"]*\.model)"/.exec(text('_rels/.rels'))?.[1] ?? '3D/3dmodel.model';
  const model = /<(?:\w+:)?model\b[^>]*>/.exec(text(target))?.[0];
  if (model === undefined) throw new Error(`the archive holds no model ${target}`);
  const required = /\brequiredextensions\s*=\s*"([^"]*)"/.exec(model)?.[1].split(/\s+/) ?? [];
  for (const prefix of required.filter(Boolean)) {
    const space = new RegExp(`xmlns:${prefix}\\s*=\\s*"([^"]*)"`).exec(model)?.[1] ?? prefix;
    if (!/\/material\//.test(space)) throw new Error(`the 3MF extension ${prefix} is required, and not supported`);
  }
  const models = Object.keys(parts).filter((name) => name.endsWith('.model'));
  if (models.some((name) => /<(?:\w+:)?(component|item)\b[^>]*\w:path\s*=/.test(text(name))))
    throw new Error('its objects are in several models');
  if (models.some((name) => /<(?:\w+:)?object\b[^>]*\btype\s*=\s*"(solid)?support"|"cura:\w+_mesh"/.test(text(name))))
    throw new Error('it holds supports or modifiers of a slicer beside the bodies');
  const config = text('Metadata/Slic3r_PE_model.config') + text('Metadata/model_settings.config');
  if (/"volume_type"\s+value="(?!ModelPart")|\bsubtype="(?!normal_part")|"modifier"\s+value="1"/.test(config)) {
    throw new Error('it is the project of a slicer, and holds modifiers or blockers of supports beside the bodies');
  }
  const unit = /\bunit\s*=\s*"(\w+)"/.exec(model)?.[1] ?? 'millimeter';
  const length = lengths[unit];
  if (!length) throw new Error(`the unit ${unit} is unknown`);
  return length;
}

/**
 * Writes the triangles of a scene, where it places them.
 * @param {import('three').Object3D} scene
 * @param {number} scale
 * @returns {ArrayBuffer}
 */
function ply(scene, scale) {
  scene.updateMatrixWorld(true);
  /** @type {{mesh: import('three').Mesh, corners: number, points: number}[]} */
  const parts = [];
  scene.traverse((object) => {
    const mesh = /** @type {import('three').Mesh} */ (object);
    if (!mesh.isMesh) return;
    const points = mesh.geometry.attributes.position?.count ?? 0;
    parts.push({mesh, points, corners: mesh.geometry.index?.count ?? points});
  });
  const points = sum(parts.map((part) => part.points)),
    faces = sum(parts.map(({corners}) => Math.floor(corners / 3)));
  if (faces === 0) throw new Error('it holds no triangle');
  const header = new TextEncoder().encode(
    `ply\nformat binary_little_endian 1.0\nelement vertex ${points}\nproperty double x\nproperty double y\nproperty double z\n` +
      `element face ${faces}\nproperty list uchar uint vertex_indices\nend_header\n`,
  );
  const result = new DataView(new ArrayBuffer(header.length + 24 * points + 13 * faces));
  new Uint8Array(result.buffer).set(header);
  let at = header.length;
  const point = new Vector3(),
    place = new Matrix4();
  for (const {mesh} of parts) {
    place.makeScale(scale, scale, scale).multiply(mesh.matrixWorld);
    const position = mesh.geometry.attributes.position;
    for (let i = 0; i < (position?.count ?? 0); ++i) {
      point.fromBufferAttribute(position, i).applyMatrix4(place);
      for (const value of point) at = (result.setFloat64(at, value, true), at + 8);
    }
  }
  let first = 0;
  for (const {mesh, points: own, corners} of parts) {
    const {index} = mesh.geometry,
      // A mirror image keeps its outer side outside.
      order = mesh.matrixWorld.determinant() < 0 ? [0, 2, 1] : [0, 1, 2];
    for (let face = 0; face + 2 < corners; face += 3) {
      result.setUint8(at++, 3);
      for (const corner of order) {
        const vertex = index ? index.getX(face + corner) : face + corner;
        if (vertex >= own) throw new Error(`a triangle names vertex ${vertex}, but there are ${own}, counted from 0`);
        result.setUint32(at, first + vertex, true);
        at += 4;
      }
    }
    first += own;
  }
  return result.buffer;
}

/** @param {number[]} numbers */
const sum = (numbers) => numbers.reduce((all, one) => all + one, 0);
