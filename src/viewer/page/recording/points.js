/** The contact points of a recorded tick. */

import {inverse, transformed, turned} from '../pose.js';

/** @typedef {import('../protocol.js').Pose} Pose */

/**
 * @typedef {object} Point
 * @property {number[]} position  on the fixed body, metres
 * @property {number[]} normal    from the fixed body to the held one
 * @property {number[]} force     on the tool, N
 * @property {number} gap         metres
 * @property {[number, number]} triangles  of the fixed and the held body
 * @property {[number, number]} bodies     their numbers
 */
/** @typedef {{at: number[], force: number[], part: number}} Arrow  `part` of the longest arrow, 0 to 1 */

/**
 * @param {unknown} written
 * @returns {Point[] | null} null if these are no contact points
 */
export function pointsOf(written) {
  const numbers = (/** @type {unknown} */ value, /** @type {number} */ count) =>
    Array.isArray(value) && value.length === count && value.every(Number.isFinite);
  const isPoint = (/** @type {any} */ point) =>
    ['position', 'normal', 'force'].every((key) => numbers(point?.[key], 3)) &&
    ['triangles', 'bodies'].every((key) => numbers(point[key], 2)) &&
    Number.isFinite(point.gap);
  return Array.isArray(written) && written.every(isPoint) ? written : null;
}

/**
 * @param {Point[]} points
 * @param {Pose} fixed            place of the first fixed body
 * @param {number} metresPerUnit
 * @param {number} strongest      N, the force of the longest arrow
 * @returns {Arrow[]} in mesh units and axes of the first fixed body
 */
export function arrowsOf(points, fixed, metresPerUnit, strongest) {
  const back = inverse(fixed);
  return points.map(({position, force}) => ({
    at: transformed(back, position).map((value) => value / metresPerUnit),
    force: turned(back, force),
    part: strongest > 0 ? Math.min(1, Math.hypot(...force) / strongest) : 0,
  }));
}
