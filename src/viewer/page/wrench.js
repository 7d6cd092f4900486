/** The force and torque of contacts, about their middle: there a person looks for them. */

/** @typedef {import('./protocol.js').Contacts} Contacts */

/**
 * @param {Contacts} contacts
 * @returns {{at: number[], force: number[], torque: number[]}} `at`: the contacts' middle by weight
 */
export function wrenchAtMiddle({positions, weights, force, torque, about}) {
  const at = [0, 0, 0];
  let sum = 0;
  for (let i = 0; i < weights.length; i++) {
    sum += weights[i];
    for (let axis = 0; axis < 3; axis++) at[axis] += weights[i] * positions[3 * i + axis];
  }
  if (sum === 0) return {at: about, force, torque};
  for (let axis = 0; axis < 3; axis++) at[axis] /= sum;
  const [x, y, z] = about.map((value, axis) => value - at[axis]);
  const [fx, fy, fz] = force;
  return {at, force, torque: [torque[0] + y * fz - z * fy, torque[1] + z * fx - x * fz, torque[2] + x * fy - y * fx]};
}
