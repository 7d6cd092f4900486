/** Nodes of both trees as drawn: a column for each policy, beside each other. */

import * as THREE from 'three';

import {clearBalls, makeBalls, mostDrawn} from './balls.js';
import {disposeLabel, makeLabel} from './label.js';

/** @typedef {import('../protocol.js').Level} Level */
/** @typedef {import('../protocol.js').Pose} Pose */
/** @typedef {import('../context.js').State} State */
/** @typedef {import('./stage.js').Stage} Stage */
/** @typedef {{fixed: Uint32Array, moving: Uint32Array}} Nodes */

/**
 * @typedef {object} Column
 * @property {string} policy
 * @property {Level} fixed
 * @property {Level} moving
 * @property {Nodes | null} touched  drawn in their own colour; null: none
 * @property {Nodes | null} only     the nodes to draw; null: all
 */

const colours = {fixed: 0xc9b48a, moving: 0x5b8fc7};
const roles = /** @type {const} */ (['fixed', 'moving']);

/**
 * @param {Stage} stage
 * @returns {{draw: (columns: Column[], pose: Pose, bodies: State['bodies']) => void, clear: () => void}}
 */
export function makeTreeView(stage) {
  const group = new THREE.Group();
  stage.fixedFrame.add(group);
  let columnsDrawn = 0;
  const empty = () => {
    for (const column of group.children) {
      for (const part of column.children) {
        if (part instanceof THREE.Sprite) disposeLabel(part);
        else clearBalls(part);
      }
    }
    group.clear();
  };
  return {
    draw(columns, pose, bodies) {
      empty();
      const step = 1.15 * (bodies.fixed?.extent ?? 1);
      for (const [at, column] of columns.entries()) {
        const x = (at - (columns.length - 1) / 2) * step;
        group.add(drawnColumn(column, pose, x, columns.length > 1 ? step : 0));
      }
      for (const role of roles) stage.fade(role, columns.length > 1 ? 0 : 0.15);
      if (columns.length !== columnsDrawn && columns.length > 1) stage.fit(new THREE.Box3().setFromObject(group), [0, -1, 0.25]);
      else if (columnsDrawn > 1) stage.frameAll();
      columnsDrawn = columns.length;
      stage.render();
    },
    clear() {
      empty();
      if (columnsDrawn > 1) stage.frameAll();
      columnsDrawn = 0;
      for (const role of roles) stage.fade(role, 1);
      stage.render();
    },
  };
}

/**
 * @param {Column} column
 * @param {Pose} pose
 * @param {number} x
 * @param {number} labelled  the width to be labelled; 0: no label
 */
function drawnColumn(column, pose, x, labelled) {
  const drawn = new THREE.Group();
  drawn.position.x = x;
  for (const role of roles) {
    const frame = new THREE.Group();
    if (role === 'moving') {
      frame.matrixAutoUpdate = false;
      frame.matrix.fromArray(pose);
    }
    const touched = new Set(column.touched?.[role] ?? []);
    const only = column.only ? column.only[role].subarray(0, mostDrawn) : null;
    frame.add(makeBalls({level: column[role], touched, only, colour: colours[role]}));
    drawn.add(frame);
  }
  if (labelled) {
    const label = makeLabel(column.policy, 0.1 * labelled);
    const {centres} = column.fixed;
    let top = -Infinity;
    for (let i = 2; i < centres.length; i += 3) top = Math.max(top, centres[i]);
    label.position.set(0, 0, (Number.isFinite(top) ? top : 0) + 0.12 * labelled);
    drawn.add(label);
  }
  return drawn;
}
