/** How both bodies face each other, as the page draws and closes them. */

import {inverse, turned} from './pose.js';

/** @typedef {import('./protocol.js').FacingReply} FacingReply */

/**
 * @typedef {object} Facing  unit vectors of fixed coordinates
 * @property {boolean} known     false: nothing is near enough to tell
 * @property {'fixed' | 'moving'} upper  the body that lies above
 * @property {number[]} up
 * @property {number[]} front    to the front teeth
 * @property {number[]} closing  the way the moving body closes
 */

/** As the built-in jaws are made: the upper one is fixed, and z is up. @type {Readonly<Facing>} */
export const builtIn = {known: true, upper: 'fixed', up: [0, 0, 1], front: [0, -1, 0], closing: [0, 0, 1]};

/**
 * @param {FacingReply} reply
 * @returns {Facing} of bodies that face nothing: as the built-in jaws
 */
export function facingOf({known, towards, front, upper}) {
  if (!towards || !front || !upper) return {...builtIn, known: false};
  const closing = towards.map((value) => 0 - value);
  return {known, upper, front, closing, up: upper === 'fixed' ? closing : towards};
}

/**
 * @param {Readonly<Facing>} facing
 * @param {import('./protocol.js').Pose} pose  of the moving body
 * @returns {Facing} of the same bodies with each other's roles
 */
export function swapped({known, upper, up, front, closing}, pose) {
  const own = (/** @type {number[]} */ direction) => turned(inverse(pose), direction);
  return {
    known,
    upper: upper === 'fixed' ? 'moving' : 'fixed',
    up: own(up),
    front: own(front),
    closing: own(closing).map((value) => 0 - value),
  };
}

/**
 * @param {Readonly<number[]>} direction  of length 1
 * @returns {string} the axis, or its three numbers
 */
export function directionWords(direction) {
  const axis = direction.findIndex((value) => Math.abs(value) > 1 - 1e-9);
  if (axis >= 0) return `${direction[axis] < 0 ? '−' : ''}${'xyz'[axis]}`;
  return `(${direction.map((value) => value.toFixed(2).replace('-', '−')).join(', ')})`;
}
