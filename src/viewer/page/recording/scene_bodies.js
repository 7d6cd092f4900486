/**
 * The bodies of a recording that came without their meshes: read from the scene's text in its header,
 * where the scene has one fixed and one held body. Only what places them is read here.
 */

import {inverse, multiply, translation} from '../pose.js';

/** @typedef {import('../protocol.js').Line} Line */
/** @typedef {import('../protocol.js').Pose} Pose */
/** @typedef {import('../protocol.js').BodyFacts} BodyFacts */
/** @typedef {import('./placed_bodies.js').Placed} Placed */

/**
 * @typedef {object} SceneBody
 * @property {string | null} shape
 * @property {number} seed
 * @property {number} voxelSize   scene's unit
 * @property {Pose} pose          mesh units to the scene, its unit
 */

/**
 * @param {Line} header
 * @returns {{fixed: SceneBody, held: SceneBody} | null} null where the scene is another
 */
export function sceneBodies(header) {
  const tables = tablesOf(String(header.scene ?? ''));
  if (header.bodies?.length !== 2 || tables.fixed?.length !== 1 || tables.held?.length !== 1) return null;
  const [fixed, held] = [tables.fixed[0], tables.held[0]].map(bodyOf);
  return fixed && held ? {fixed, held} : null;
}

/**
 * @param {{fixed: SceneBody, held: SceneBody}} scene
 * @param {{fixed: BodyFacts, moving: BodyFacts}} facts
 * @param {Line} header
 * @returns {Placed[]} metres
 */
export function placedByScene({fixed, held}, facts, header) {
  const unit = header.unit;
  const centre = rootCentre(facts.moving, held.voxelSize);
  const heldPose = inMetres(held.pose, unit);
  // The tool's frame has the held body's axes, and its origin in the middle of the root cube.
  const tool = multiply(heldPose, translation(centre.map((value) => value * unit)));
  const [fixedName, heldName] = header.bodies.map((/** @type {Line} */ body) => body.name);
  return [
    {name: fixedName, held: false, pose: inMetres(fixed.pose, unit)},
    {name: heldName, held: true, pose: heldPose, in_tool: multiply(inverse(tool), heldPose)},
  ];
}

/**
 * @param {BodyFacts} facts
 * @param {number} voxelSize
 * @returns {number[]} the middle of the root cube: a power of two of voxels from the box's corner on
 */
function rootCentre({info}, voxelSize) {
  /** @type {number[]} */
  const least = info.box_min;
  const cells = Math.max(...least.map((from, axis) => Math.max(1, Math.ceil((info.box_max[axis] - from) / voxelSize))));
  const edge = voxelSize * 2 ** Math.ceil(Math.log2(cells));
  return least.map((from) => from + edge / 2);
}

/**
 * @param {Pose} pose
 * @param {number} metresPerUnit
 */
function inMetres(pose, metresPerUnit) {
  return pose.map((value, at) => (at >= 12 && at < 15 ? value * metresPerUnit : value));
}

/**
 * The tables of a scene, as far as their keys stand on one line each.
 * @param {string} text  TOML
 * @returns {Record<string, Record<string, string>[]>}
 */
function tablesOf(text) {
  /** @type {Record<string, Record<string, string>[]>} */
  const tables = {};
  /** @type {Record<string, string> | null} */
  let current = null;
  for (const line of text.split('\n')) {
    const table = /^\s*\[+\s*([\w.]+)\s*\]+/.exec(line);
    const key = /^\s*(\w+)\s*=\s*(.*)$/.exec(line);
    if (table) {
      current = {};
      (tables[table[1]] ??= []).push(current);
    } else if (key && current) {
      current[key[1]] = key[2].trim();
    }
  }
  return tables;
}

/**
 * @param {Record<string, string>} table
 * @returns {SceneBody | null}
 */
function bodyOf(table) {
  const numbers = (/** @type {string | undefined} */ text) => (text?.split('#')[0].match(/[-+]?[\d.]+(?:e[-+]?\d+)?/gi) ?? []).map(Number);
  const [voxelSize] = numbers(table.voxel_size);
  if (!(voxelSize > 0)) return null;
  const shift = table.translation ? numbers(table.translation) : [0, 0, 0];
  const turn = table.quaternion ? numbers(table.quaternion) : [1, 0, 0, 0];
  if (shift.length !== 3 || turn.length !== 4) return null;
  return {
    shape: /^"([^"]*)"/.exec(table.shape ?? '')?.[1] ?? null,
    seed: numbers(table.seed)[0] ?? 1,
    voxelSize,
    pose: multiply(translation(shift), turned(turn)),
  };
}

/**
 * @param {number[]} quaternion  w first, of any length
 * @returns {Pose}
 */
function turned(quaternion) {
  const length = Math.hypot(...quaternion) || 1;
  const [w, x, y, z] = quaternion.map((value) => value / length);
  return [
    1 - 2 * (y * y + z * z),
    2 * (x * y + w * z),
    2 * (x * z - w * y),
    0,
    2 * (x * y - w * z),
    1 - 2 * (x * x + z * z),
    2 * (y * z + w * x),
    0,
    2 * (x * z + w * y),
    2 * (y * z - w * x),
    1 - 2 * (x * x + y * y),
    0,
    0,
    0,
    0,
    1,
  ];
}
