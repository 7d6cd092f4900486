/** Axes of a plot: what lies where, and which values get a tick. */

/**
 * @typedef {object} Scale
 * @property {number} from
 * @property {number} to
 * @property {boolean} logarithmic
 */

/**
 * The scale that holds all values, or 0 to 1 where there are none.
 * @param {Iterable<number>} values
 * @param {boolean} logarithmic  values of 0 and less are then passed over
 * @returns {Scale}
 */
export function scaleOf(values, logarithmic) {
  let [from, to] = [Infinity, -Infinity];
  for (const value of values) {
    if (!Number.isFinite(value) || (logarithmic && value <= 0)) continue;
    from = Math.min(from, value);
    to = Math.max(to, value);
  }
  if (from > to) return logarithmic ? {from: 0.1, to: 10, logarithmic} : {from: 0, to: 1, logarithmic};
  if (logarithmic) {
    const room = Math.max(1.15, (to / from) ** 0.05);
    return {from: from / room, to: to * room, logarithmic};
  }
  if (from === to) return {from: from - (Math.abs(from) || 1) / 2, to: to + (Math.abs(to) || 1) / 2, logarithmic};
  return {from, to, logarithmic};
}

/**
 * @param {Scale} scale
 * @param {number} value
 * @returns {number} 0 at the start of the axis, 1 at its end
 */
export function partAt({from, to, logarithmic}, value) {
  return logarithmic ? Math.log(value / from) / Math.log(to / from) : (value - from) / (to - from);
}

/**
 * @param {Scale} scale
 * @param {number} part
 */
export function valueAt({from, to, logarithmic}, part) {
  return logarithmic ? from * (to / from) ** part : from + (to - from) * part;
}

/**
 * @param {Scale} scale
 * @param {number} about  how many ticks there should be
 * @returns {number[]} round values, ascending
 */
export function ticksOf({from, to, logarithmic}, about) {
  if (logarithmic && to / from > 4) return logarithmicTicks(from, to, about);
  const rough = (to - from) / about;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * ([1, 2, 5].find((each) => each * power >= rough) ?? 10);
  const ticks = [];
  for (let k = Math.ceil(from / step - 1e-9); k * step <= to + 1e-9 * step; k++) ticks.push(Number((k * step).toPrecision(12)));
  return ticks;
}

/**
 * Of each of many buckets along x the least and the greatest point, in order: a line through them
 * looks as one through all.
 * @param {[number, number][]} points  ascending in x
 * @param {number} buckets
 * @returns {[number, number][]}
 */
export function thinned(points, buckets) {
  if (points.length <= 2 * buckets) return points;
  /** @type {[number, number][]} */
  const kept = [];
  for (let bucket = 0; bucket < buckets; bucket++) {
    const begin = Math.floor((bucket * points.length) / buckets);
    const end = Math.floor(((bucket + 1) * points.length) / buckets);
    let [least, greatest] = [begin, begin];
    for (let i = begin; i < end; i++) {
      if (points[i][1] < points[least][1]) least = i;
      if (points[i][1] > points[greatest][1]) greatest = i;
    }
    kept.push(points[Math.min(least, greatest)]);
    if (least !== greatest) kept.push(points[Math.max(least, greatest)]);
  }
  return kept;
}

/**
 * @param {number} from
 * @param {number} to
 * @param {number} about
 */
function logarithmicTicks(from, to, about) {
  const decades = Math.log10(to / from);
  const of = decades > about ? [1] : decades > about / 2 ? [1, 3] : [1, 2, 5];
  const ticks = [];
  for (let power = Math.floor(Math.log10(from)); power <= Math.ceil(Math.log10(to)); power++) {
    for (const digit of of) {
      const value = Number((digit * 10 ** power).toPrecision(12));
      if (value >= from && value <= to) ticks.push(value);
    }
  }
  return ticks;
}
