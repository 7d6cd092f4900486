/** A point of the fixed body that is marked and named, through all that is in front of it, until the moving body moves. */

import * as THREE from 'three';

import {disposeLabel, makeLabel} from './label.js';
import {threeOf} from './stage.js';

/** @typedef {import('../context.js').Store} Store */
/** @typedef {import('./stage.js').Stage} Stage */

/**
 * @param {Stage} stage
 * @param {Store} store
 * @returns {{show: (point: number[], name: string) => void}}  at the pose of now; fixed coordinates
 */
export function makePointMark(stage, store) {
  if (!stage.drawn) return {show: () => {}};
  const group = new THREE.Group();
  const ball = new THREE.IcosahedronGeometry(1, 2);
  const through = {depthTest: false, transparent: true};
  const rim = new THREE.Mesh(ball, new THREE.MeshBasicMaterial({color: 0x111111, ...through})),
    core = new THREE.Mesh(ball, new THREE.MeshBasicMaterial({color: 0xf0e442, ...through}));
  rim.renderOrder = 3;
  core.renderOrder = 4;
  group.visible = false;
  stage.fixedFrame.add(group);
  /** @type {THREE.Sprite | null} */
  let label = null;
  /** @type {import('../protocol.js').Pose | null} */
  let at = null;
  store.subscribe(['pose', 'bodies', 'book'], ({pose, book}) => {
    group.visible = at === pose && !book;
    stage.render();
  });
  return {
    show(point, name) {
      const {pose, bodies, book} = store.get();
      const size = bodies.moving?.extent ?? 100;
      at = pose;
      if (label) disposeLabel(label);
      label = makeLabel(name, 0.02 * size);
      label.center.set(0.5, -0.4);
      rim.scale.setScalar(0.007 * size);
      core.scale.setScalar(0.005 * size);
      group.clear();
      group.add(rim, core, label);
      group.position.set(...threeOf(point));
      group.visible = !book;
      stage.render();
    },
  };
}
