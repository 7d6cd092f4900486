/** The way of the tool through a recording, where the tool's frame stands alone in the picture. */

/** @typedef {import('./recording.js').Tick} Tick */

/**
 * @param {Tick[]} ticks  at least one
 * @param {number} scale  of the picture's lengths to metres
 * @returns {{points: number[], middle: number[], size: number}} three numbers a tick; their mean; and how
 *   far from it the farthest coordinate is, 1 at least
 */
export function toolPath(ticks, scale) {
  /** @type {number[]} */
  const points = [];
  const middle = [0, 0, 0];
  for (const {tool} of ticks) {
    for (let axis = 0; axis < 3; axis++) {
      const place = tool[12 + axis] * scale;
      points.push(place);
      middle[axis] += place / ticks.length;
    }
  }
  // An hour has millions of numbers: too many for the arguments of one call.
  const size = points.reduce((most, place, at) => Math.max(most, Math.abs(place - middle[at % 3])), 1);
  return {points, middle, size};
}
