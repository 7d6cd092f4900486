/** The triangles of a body on which its distance map is known. */

/**
 * Sorts the triangles of a body: first those on which the distance may be taken as linear, as the report draws them. On those it is
 * known at all corners, and nowhere steeper than a distance can be; it is steeper where a sign is wrong, at the border of an open scan.
 * @param {Float32Array} positions
 * @param {Uint32Array} triangles
 * @param {Float32Array} distances  of each vertex; NaN beyond the reach
 * @returns {{triangles: Uint32Array, mapped: number}}  `mapped`: how many indices are of such triangles
 */
export function mappedFirst(positions, triangles, distances) {
  const isMapped = (/** @type {number} */ first) =>
    [0, 1, 2].every((k) => {
      const a = triangles[first + k],
        b = triangles[first + ((k + 1) % 3)];
      const [x, y, z] = [0, 1, 2].map((axis) => positions[3 * a + axis] - positions[3 * b + axis]);
      return Math.abs(distances[a] - distances[b]) <= 1.001 * Math.hypot(x, y, z);
    });
  const sorted = new Uint32Array(triangles.length);
  let front = 0,
    back = triangles.length;
  for (let first = 0; first < triangles.length; first += 3) {
    const mapped = isMapped(first);
    if (!mapped) back -= 3;
    sorted.set(triangles.subarray(first, first + 3), mapped ? front : back);
    if (mapped) front += 3;
  }
  return {triangles: sorted, mapped: front};
}
