/** Contact points of a recorded tick: a dot on the surface, and an arrow by force. */

import * as THREE from 'three';

import {makeArrow, pointArrow} from './arrow.js';
import {threeOf} from './stage.js';

/** @typedef {import('../recording/points.js').Arrow} Arrow */

// The colours of contacts: they differ for the colour-blind too.
const weak = new THREE.Color(0x56b4e9),
  strong = new THREE.Color(0xd55e00);
const shortest = 0.03,
  longest = 0.2;

/**
 * @param {THREE.Group} group
 * @returns {{set: (arrows: Arrow[], size: number) => void}}
 */
export function makePointArrows(group) {
  const ball = new THREE.IcosahedronGeometry(1, 1);
  /** @type {{dot: THREE.Mesh<THREE.IcosahedronGeometry, THREE.MeshBasicMaterial>, arrow: THREE.ArrowHelper}[]} */
  const marks = [];
  const grow = () => {
    const dot = new THREE.Mesh(ball, new THREE.MeshBasicMaterial({depthTest: false, transparent: true}));
    dot.renderOrder = 4;
    const mark = {dot, arrow: makeArrow(0)};
    group.add(dot, mark.arrow);
    marks.push(mark);
  };
  const colour = new THREE.Color();
  return {
    set(arrows, size) {
      while (marks.length < arrows.length) grow();
      for (const [i, {dot, arrow}] of marks.entries()) {
        dot.visible = arrow.visible = i < arrows.length;
        if (!dot.visible) continue;
        const {at, force, part} = arrows[i];
        dot.position.set(...threeOf(at));
        dot.scale.setScalar(0.006 * size);
        colour.lerpColors(weak, strong, part);
        dot.material.color.copy(colour);
        arrow.setColor(colour);
        pointArrow(arrow, dot.position, force, (shortest + (longest - shortest) * part) * size);
      }
    },
  };
}
