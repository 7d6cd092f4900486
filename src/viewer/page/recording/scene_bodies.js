/**
 * The bodies of a recording without meshes, read from the scene's text in its header. Only scenes of
 * one fixed and one held body are read, and only the keys that place them.
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
 * @property {Pose} pose          mesh units to the scene, its unit
 * @property {number[] | null} origin  of the tool, if the scene names one; mesh units
 */

/**
 * @param {Line} header
 * @returns {{fixed: SceneBody, held: SceneBody} | null} null if the scene is another
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
  const centre = held.origin ?? middleOf(facts.moving);
  const heldPose = inMetres(held.pose, unit);
  // The tool's frame has the held body's axes, and by default its origin is the middle of the mesh's box.
  const tool = multiply(heldPose, translation(centre.map((value) => value * unit)));
  const [fixedName, heldName] = header.bodies.map((/** @type {Line} */ body) => body.name);
  return [
    {name: fixedName, held: false, pose: inMetres(fixed.pose, unit)},
    {name: heldName, held: true, pose: heldPose, in_tool: multiply(inverse(tool), heldPose)},
  ];
}

/**
 * @param {BodyFacts} facts
 * @returns {number[]}
 */
function middleOf({info}) {
  return info.box_min.map((/** @type {number} */ least, /** @type {number} */ axis) => (least + info.box_max[axis]) / 2);
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
  if (!table.shape && !table.voxel_size && /\.ist"/.test(table.file ?? '')) return null;
  const shift = table.translation ? numbers(table.translation) : [0, 0, 0];
  const turn = table.quaternion ? numbers(table.quaternion) : [1, 0, 0, 0];
  const origin = table.origin ? numbers(table.origin) : null;
  if (shift.length !== 3 || turn.length !== 4 || (origin && origin.length !== 3)) return null;
  return {
    shape: /^"([^"]*)"/.exec(table.shape ?? '')?.[1] ?? null,
    seed: numbers(table.seed)[0] ?? 1,
    pose: multiply(translation(shift), turned(turn)),
    origin,
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
