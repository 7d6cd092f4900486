/** The nearest points of both bodies and a line between them, drawn over all that is in front of them. */

import * as THREE from 'three';

import {isHere} from '../follow.js';
import {nearestPoints} from '../words.js';
import {threeOf} from './stage.js';

/** @typedef {import('../context.js').Store} Store */
/** @typedef {import('./stage.js').Stage} Stage */

const colour = 0xf0e442;

/**
 * @param {Stage} stage
 * @param {Store} store
 * @returns {{show: (on: boolean) => void}}  of the answer at the pose; fixed coordinates
 */
export function makeNearestLine(stage, store) {
  if (!stage.drawn) return {show: () => {}};
  const through = {color: colour, depthTest: false, transparent: true};
  const line = new THREE.Line(new THREE.BufferGeometry(), new THREE.LineBasicMaterial(through));
  const ends = ['fixed', 'moving'].map(() => new THREE.Mesh(new THREE.IcosahedronGeometry(1, 1), new THREE.MeshBasicMaterial(through)));
  const group = new THREE.Group();
  group.add(line, ...ends);
  for (const each of group.children) each.renderOrder = 3;
  line.frustumCulled = false;
  group.visible = false;
  stage.fixedFrame.add(group);
  let on = false;
  const draw = () => {
    const state = store.get();
    const {answer, bodies, book} = state;
    const points = answer && isHere(state, answer) ? nearestPoints(answer.line) : null;
    group.visible = on && !book && points !== null;
    if (points) {
      const both = points.map((point) => new THREE.Vector3(...threeOf(point)));
      line.geometry.setFromPoints(both);
      for (const [at, end] of ends.entries()) {
        end.position.copy(both[at]);
        end.scale.setScalar(0.004 * (bodies.moving?.extent ?? 100));
      }
    }
    stage.render();
  };
  store.subscribe(['answer', 'pose', 'policy', 'bodies', 'book'], draw);
  return {
    show(shown) {
      on = shown;
      draw();
    },
  };
}
