/**
 * Where each body of a recording is at each tick. Lengths of poses are metres here, as in a
 * recording; for the picture they become the first fixed body's mesh units.
 */

import {inverse, multiply} from '../pose.js';

/** @typedef {import('../protocol.js').Pose} Pose */
/** @typedef {import('./recording.js').Recording} Recording */
/** @typedef {{name: string, held: boolean, pose: Pose, in_tool?: Pose}} Placed  before the first tick */
/** @typedef {{from: number, held: boolean, pose: Pose}} Span  from a tick on: in the scene, or in the tool's frame if held */

/**
 * @param {Placed[]} bodies
 * @param {Recording} recording
 * @returns {Span[][]} of each body, ascending
 */
export function spansOf(bodies, {ticks, changes}) {
  return bodies.map((body) => {
    /** @type {Span[]} */
    const spans = [{from: 0, held: body.held, pose: body.held ? (body.in_tool ?? multiply(inverse(ticks[0].tool), body.pose)) : body.pose}];
    for (const change of changes) {
      if (change.body !== body.name || change.status !== 'done') continue;
      const last = spans[spans.length - 1];
      const tool = ticks[Math.max(0, change.before - 1)].tool;
      if (change.kind === 'attach' && !last.held) {
        spans.push({from: change.before, held: true, pose: multiply(inverse(tool), last.pose)});
      } else if (change.kind === 'release' && last.held) {
        spans.push({from: change.before, held: false, pose: multiply(tool, last.pose)});
      }
    }
    return spans;
  });
}

/**
 * @param {Span[]} spans
 * @param {number} at     index of a tick
 * @param {Pose} tool     of that tick, or the device's
 * @returns {Pose} the body's place in the scene
 */
export function placeAt(spans, at, tool) {
  let span = spans[0];
  for (const each of spans) {
    if (each.from <= at) span = each;
  }
  return span.held ? multiply(tool, span.pose) : span.pose;
}

/**
 * @param {Pose} fixed   place of the first fixed body
 * @param {Pose} body    place of another
 * @param {number} metresPerUnit
 * @returns {Pose} maps the other's mesh coordinates to the fixed body's, mesh units
 */
export function relative(fixed, body, metresPerUnit) {
  const pose = multiply(inverse(fixed), body);
  for (const at of [12, 13, 14]) pose[at] /= metresPerUnit;
  return pose;
}
