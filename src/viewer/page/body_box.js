/** The box round a body, its own coordinates. */

/** @typedef {import('./protocol.js').BodyFacts} BodyFacts */
/** @typedef {{least: number[], greatest: number[]}} Box */

/** @type {WeakMap<BodyFacts, Box>} */
const known = new WeakMap();

/**
 * @param {BodyFacts} facts
 * @returns {Box}
 */
function boxOf(facts) {
  const found = known.get(facts);
  if (found) return found;
  const least = [Infinity, Infinity, Infinity],
    greatest = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < facts.positions.length; i++) {
    least[i % 3] = Math.min(least[i % 3], facts.positions[i]);
    greatest[i % 3] = Math.max(greatest[i % 3], facts.positions[i]);
  }
  const box = {least, greatest};
  known.set(facts, box);
  return box;
}

/**
 * @param {BodyFacts | null} facts
 * @returns {number[]} the middle of the box, about which the body turns
 */
export function middleOf(facts) {
  if (!facts || facts.positions.length === 0) return [0, 0, 0];
  const {least, greatest} = boxOf(facts);
  return least.map((value, axis) => (value + greatest[axis]) / 2);
}
