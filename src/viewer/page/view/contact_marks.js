/** Contacts as drawn: a dot and its normal each, coloured by depth, and the arrows of force and torque. */

import * as THREE from 'three';

import {wrenchAtMiddle} from '../wrench.js';
import {makeArrow, pointArrow} from './arrow.js';

/** @typedef {import('./stage.js').Stage} Stage */
/** @typedef {import('../protocol.js').Contacts} Contacts */

/**
 * @typedef {object} ContactMarks
 * @property {(contacts: Contacts | null, extent: number) => void} set
 * @property {(on: boolean) => void} show
 * @property {(at: number) => void} choose  marks one contact; -1: none
 */

const most = 4096;
// Apart, and deep in each other: apart for the colour-blind too.
const shallow = new THREE.Color(0x56b4e9),
  deep = new THREE.Color(0xd55e00),
  chosenColour = new THREE.Color(0xf0e442);
const forceColour = 0x009e73,
  torqueColour = 0xcc79a7;

/**
 * @param {Stage} stage
 * @returns {ContactMarks}
 */
export function makeContactMarks(stage) {
  if (!stage.drawn) return {set: () => {}, show: () => {}, choose: () => {}};
  const group = new THREE.Group();
  group.visible = false;
  // Contacts lie between both bodies, so they are drawn over them.
  const through = {depthTest: false, transparent: true};
  const dots = new THREE.InstancedMesh(new THREE.IcosahedronGeometry(1, 1), new THREE.MeshBasicMaterial(through), most);
  dots.frustumCulled = false;
  dots.renderOrder = 2;
  const normals = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({color: 0x444444, ...through}));
  normals.frustumCulled = false;
  normals.renderOrder = 1;
  const lines = new THREE.BufferAttribute(new Float32Array(6 * most), 3);
  normals.geometry.setAttribute('position', lines);
  const force = makeArrow(forceColour),
    torque = makeArrow(torqueColour);
  group.add(dots, normals, force, torque);
  stage.fixedFrame.add(group);
  let chosen = -1;
  /** @type {Contacts | null} */
  let shown = null;
  let size = 1;

  const draw = () => {
    const contacts = shown;
    const count = contacts ? Math.min(most, contacts.depths.length) : 0;
    dots.count = count;
    normals.geometry.setDrawRange(0, 2 * count);
    force.visible = torque.visible = false;
    if (contacts) {
      placeDots(contacts, count);
      const wrench = wrenchAtMiddle(contacts);
      const at = new THREE.Vector3(...wrench.at);
      // The lengths are fixed. The panel has the amounts.
      pointArrow(force, at, wrench.force, 0.3 * size);
      pointArrow(torque, at, wrench.torque, 0.2 * size);
    }
    dots.instanceMatrix.needsUpdate = true;
    if (dots.instanceColor) dots.instanceColor.needsUpdate = true;
    lines.needsUpdate = true;
    stage.render();
  };
  const matrix = new THREE.Matrix4(),
    colour = new THREE.Color();
  /**
   * @param {Contacts} contacts
   * @param {number} count
   */
  const placeDots = ({positions, normals: directions, depths}, count) => {
    let deepest = 1e-300;
    for (let i = 0; i < count; i++) deepest = Math.max(deepest, depths[i]);
    for (let i = 0; i < count; i++) {
      const radius = (i === chosen ? 0.009 : 0.005) * size;
      matrix.makeScale(radius, radius, radius).setPosition(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]);
      dots.setMatrixAt(i, matrix);
      dots.setColorAt(i, i === chosen ? chosenColour : colour.lerpColors(shallow, deep, Math.max(0, depths[i]) / deepest));
      for (let axis = 0; axis < 3; axis++) {
        lines.array[6 * i + axis] = positions[3 * i + axis];
        lines.array[6 * i + 3 + axis] = positions[3 * i + axis] + 0.03 * size * directions[3 * i + axis];
      }
    }
  };
  return {
    set(contacts, extent) {
      [shown, size, chosen] = [contacts, extent, -1];
      if (group.visible) draw();
    },
    show(on) {
      group.visible = on;
      draw();
    },
    choose(at) {
      chosen = at;
      draw();
    },
  };
}
