/** An arrow of a force or a torque, drawn through all that is in front of it. */

import * as THREE from 'three';

/**
 * @param {number} colour
 * @returns {THREE.ArrowHelper}
 */
export function makeArrow(colour) {
  const made = new THREE.ArrowHelper(new THREE.Vector3(0, 0, 1), new THREE.Vector3(), 1, colour);
  for (const part of [made.line, made.cone]) {
    const material = /** @type {THREE.Material} */ (part.material);
    material.depthTest = false;
    material.transparent = true;
    part.renderOrder = 3;
  }
  return made;
}

/**
 * Hides the arrow if it has no direction.
 * @param {THREE.ArrowHelper} arrow
 * @param {THREE.Vector3} from
 * @param {number[]} along   of any length
 * @param {number} length
 */
export function pointArrow(arrow, from, along, length) {
  const direction = new THREE.Vector3(...along);
  arrow.visible = direction.length() > 0;
  if (!arrow.visible) return;
  arrow.position.copy(from);
  arrow.setDirection(direction.normalize());
  arrow.setLength(length, 0.25 * length, 0.12 * length);
}
