/**
 * Poses as people read them. A pose is 16 numbers, column by column: a rotation and a translation,
 * moving to fixed coordinates. Six numbers say the same: a shift along each axis, and the turns about
 * x, then y, then z through the moving body's centre, in degrees.
 *
 * @typedef {import('./protocol.js').Pose} Pose
 * @typedef {{shift: number[], turn: number[]}} SixNumbers  mesh units, degrees
 */

/** @type {Readonly<number[]>} */
export const identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

const degree = Math.PI / 180;
// The engine makes a rotation this near to orthonormal exact, and refuses a scale beyond its limit.
const orthonormalTo = 1e-3;
const scaleTo = 1e-5;

/**
 * @param {readonly number[]} a
 * @param {readonly number[]} b
 * @returns {Pose} b first, then a
 */
export function multiply(a, b) {
  const product = new Array(16);
  for (let column = 0; column < 4; column++) {
    for (let row = 0; row < 4; row++) {
      let sum = 0;
      for (let k = 0; k < 4; k++) sum += a[k * 4 + row] * b[column * 4 + k];
      product[column * 4 + row] = sum;
    }
  }
  return product;
}

/**
 * @param {readonly number[]} pose
 * @returns {Pose} the way back
 */
export function inverse(pose) {
  const [xx, xy, xz, , yx, yy, yz, , zx, zy, zz, , tx, ty, tz] = pose;
  return [
    xx,
    yx,
    zx,
    0,
    xy,
    yy,
    zy,
    0,
    xz,
    yz,
    zz,
    0,
    -(xx * tx + xy * ty + xz * tz),
    -(yx * tx + yy * ty + yz * tz),
    -(zx * tx + zy * ty + zz * tz),
    1,
  ];
}

/**
 * @param {readonly number[]} pose
 * @param {ArrayLike<number>} point
 * @returns {[number, number, number]}
 */
export function transformed(pose, point) {
  const [x, y, z] = [point[0], point[1], point[2]];
  return [
    pose[0] * x + pose[4] * y + pose[8] * z + pose[12],
    pose[1] * x + pose[5] * y + pose[9] * z + pose[13],
    pose[2] * x + pose[6] * y + pose[10] * z + pose[14],
  ];
}

/**
 * @param {readonly number[]} pose
 * @param {readonly number[]} direction
 * @returns {number[]} turned by the pose, not shifted
 */
export function turned(pose, direction) {
  const from = transformed(pose, [0, 0, 0]);
  return transformed(pose, direction).map((value, axis) => value - from[axis]);
}

/**
 * @param {readonly number[]} from  a pose
 * @param {readonly number[]} to    another one
 * @param {readonly number[]} point
 * @param {readonly number[]} direction  of length 1
 * @returns {number} how far the point goes along the direction
 */
export function along(from, to, point, direction) {
  const begin = transformed(from, point),
    end = transformed(to, point);
  return direction.reduce((sum, part, axis) => sum + part * (end[axis] - begin[axis]), 0);
}

/**
 * @param {readonly number[]} shift
 * @returns {Pose}
 */
export function translation(shift) {
  return [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, shift[0], shift[1], shift[2], 1];
}

/**
 * The pose moved along an axis of the fixed body.
 * @param {readonly number[]} pose
 * @param {number[]} shift
 */
export function moved(pose, shift) {
  return multiply(translation(shift), pose);
}

/**
 * @param {number[][]} gram
 * @param {number} square
 * @param {number} sign
 * @returns {boolean} whether all eigenvalues of sign * (gram - square I) are above 0, by the leading minors
 */
function allBeyond(gram, square, sign) {
  const [a, b, c] = gram.map((row, i) => row.map((entry, k) => sign * (entry - (i === k ? square : 0))));
  const minor = a[0] * b[1] - a[1] * b[0];
  const whole = c[2] * minor - c[1] * (a[0] * b[2] - a[2] * b[0]) + c[0] * (a[1] * b[2] - a[2] * b[1]);
  return a[0] > 0 && minor > 0 && whole > 0;
}

/**
 * @param {unknown} numbers
 * @returns {boolean} whether the engine takes them as a pose
 */
export function isRigid(numbers) {
  if (!Array.isArray(numbers) || numbers.length !== 16 || !numbers.every(Number.isFinite)) return false;
  if (numbers[3] !== 0 || numbers[7] !== 0 || numbers[11] !== 0 || numbers[15] !== 1) return false;
  const columns = [0, 4, 8].map((at) => numbers.slice(at, at + 3));
  const dot = (/** @type {number[]} */ a, /** @type {number[]} */ b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const gram = columns.map((one) => columns.map((other) => dot(one, other)));
  const off = (/** @type {number} */ i, /** @type {number} */ k) => Math.abs(gram[i][k] - (i === k ? 1 : 0));
  for (let i = 0; i < 3; i++) for (let k = i; k < 3; k++) if (off(i, k) > orthonormalTo) return false;
  if (allBeyond(gram, (1 + scaleTo) ** 2, 1) || allBeyond(gram, (1 - scaleTo) ** 2, -1)) return false;
  const [a, b, c] = columns;
  const handed = dot([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]], c);
  return handed > 0;
}

/**
 * @param {SixNumbers} six
 * @param {readonly number[]} centre  about which the moving body turns, its own coordinates
 * @returns {Pose}
 */
export function fromSixNumbers({shift, turn}, centre) {
  const [cx, cy, cz] = turn.map((angle) => Math.cos(angle * degree));
  const [sx, sy, sz] = turn.map((angle) => Math.sin(angle * degree));
  const rotation = [
    cz * cy,
    sz * cy,
    -sy,
    0,
    cz * sy * sx - sz * cx,
    sz * sy * sx + cz * cx,
    cy * sx,
    0,
    cz * sy * cx + sz * sx,
    sz * sy * cx - cz * sx,
    cy * cx,
    0,
    0,
    0,
    0,
    1,
  ];
  const turned = transformed(rotation, centre);
  for (let axis = 0; axis < 3; axis++) rotation[12 + axis] = centre[axis] + shift[axis] - turned[axis];
  return rotation;
}

/**
 * @param {readonly number[]} pose
 * @param {readonly number[]} centre
 * @returns {SixNumbers}
 */
export function toSixNumbers(pose, centre) {
  const place = transformed(pose, centre);
  const level = Math.hypot(pose[0], pose[1]);
  // Looking along x straight up or down, turns about x and z are the same: all is given to x.
  const turn =
    level > 1e-9
      ? [Math.atan2(pose[6], pose[10]), Math.atan2(-pose[2], level), Math.atan2(pose[1], pose[0])]
      : [Math.atan2(-pose[9], pose[5]), Math.atan2(-pose[2], level), 0];
  return {shift: place.map((value, axis) => value - centre[axis]), turn: turn.map((angle) => angle / degree)};
}

/**
 * Reads a matrix that somebody pasted: 16 numbers on one line, or in JSON, are column by column, as
 * the command writes them; four lines of four numbers are rows.
 * @param {string} text
 * @returns {Pose}
 */
export function parseMatrix(text) {
  const rows = text
    .trim()
    .split(/[\n;]/)
    .map((line) => line.trim())
    .filter((line) => /\d/.test(line));
  const numbers = (text.match(/[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?|\bnan\b|\binf(?:inity)?\b/gi) ?? []).map(Number);
  if (numbers.length !== 16) {
    throw new Error(
      `A pose has 16 numbers, and this text has ${numbers.length}: paste them column by column in one line, or as four rows of four.`,
    );
  }
  if (!numbers.every(Number.isFinite)) {
    throw new Error('One of the 16 numbers is not finite: a pose has finite numbers only.');
  }
  const written = rows.length === 4 && rows.every((row) => (row.match(/\d+\.?\d*(?:e[-+]?\d+)?/gi) ?? []).length >= 4);
  const pose = written ? transposed(numbers) : numbers;
  if (isRigid(pose)) return pose;
  if (isRigid(transposed(pose))) {
    throw new Error(
      written
        ? 'These rows are a pose written column by column: put the 16 numbers in one line.'
        : 'These 16 numbers are a pose written row by row: put them in four lines of four.',
    );
  }
  throw new Error(
    'These 16 numbers are no rigid pose: the first three columns must be at right angles and of length 1, and the last row 0 0 0 1.',
  );
}

/**
 * @param {readonly number[]} pose
 * @returns {string} four rows, which parseMatrix() and `--matrix` read
 */
export function matrixText(pose) {
  return [0, 1, 2, 3].map((row) => [0, 4, 8, 12].map((column) => String(pose[column + row])).join(' ')).join('\n') + '\n';
}

/**
 * @param {readonly number[]} pose
 * @returns {Pose}
 */
function transposed(pose) {
  return pose.map((_, at) => pose[(at % 4) * 4 + Math.floor(at / 4)]);
}
