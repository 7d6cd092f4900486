/** Handles on the moving body, which shift and turn it about its middle. */

import * as THREE from 'three';
import {TransformControls} from 'three/addons/controls/TransformControls.js';

import {middleOf} from '../body_box.js';
import {multiply, transformed, translation} from '../pose.js';

/** @typedef {import('../context.js').Store} Store */
/** @typedef {import('./stage.js').Stage} Stage */
/** @typedef {'translate' | 'rotate'} Mode */

/**
 * @typedef {object} Gizmo
 * @property {(mode: Mode) => void} setMode
 * @property {(on: boolean) => void} show
 */

/**
 * @param {Stage} stage
 * @param {Store} store
 * @returns {Gizmo}
 */
export function makeGizmo(stage, store) {
  if (!stage.drawn) return {setMode: () => {}, show: () => {}};
  const handle = new THREE.Object3D();
  const controls = new TransformControls(stage.camera, stage.surface);
  controls.setSize(0.8);
  controls.attach(handle);
  stage.fixedFrame.add(handle, controls.getHelper());
  /** @type {number[]} */
  let centre = [0, 0, 0];
  let wanted = false;

  const follow = () => {
    const {pose, bodies, book} = store.get();
    centre = middleOf(bodies.moving);
    handle.position.set(...transformed(pose, centre));
    handle.quaternion.setFromRotationMatrix(new THREE.Matrix4().fromArray(pose));
    const on = wanted && bodies.moving !== null && !book;
    controls.enabled = on;
    controls.getHelper().visible = on;
    stage.render();
  };
  controls.addEventListener('change', () => stage.render());
  controls.addEventListener('dragging-changed', (event) => {
    const dragging = Boolean(event.value);
    stage.orbit(!dragging);
    store.set({dragging});
  });
  controls.addEventListener('objectChange', () => {
    handle.updateMatrix();
    store.set({pose: multiply(handle.matrix.toArray(), translation(centre.map((value) => -value)))});
  });
  store.subscribe(['pose', 'bodies', 'book'], () => {
    if (!controls.dragging) follow();
  });
  return {
    setMode: (mode) => controls.setMode(mode),
    show(on) {
      wanted = on;
      follow();
    },
  };
}
