/** Nodes of one level of a tree: balls, or the slabs that cut them, as flat discs. */

import * as THREE from 'three';

/** @typedef {import('../protocol.js').Level} Level */
/** @typedef {{level: Level, touched: Set<number>, only: Uint32Array | null, colour: number}} Drawn */

/** More are not drawn: the touched ones alone are then. */
export const mostDrawn = 30_000;

const touchedColour = new THREE.Color(0xd55e00);
const ball = new THREE.IcosahedronGeometry(1, 1);
const disc = new THREE.CylinderGeometry(1, 1, 1, 14).rotateX(Math.PI / 2);

/**
 * @param {Drawn} drawn  `only`: places of the nodes to draw; null: all
 * @returns {THREE.InstancedMesh}
 */
export function makeBalls({level, touched, only, colour}) {
  const slabs = level.normals !== undefined;
  const count = only ? only.length : level.radii.length;
  const material = new THREE.MeshStandardMaterial({roughness: 0.8, transparent: true, opacity: slabs ? 0.85 : 0.5, depthWrite: slabs});
  const mesh = new THREE.InstancedMesh(slabs ? disc : ball, material, count);
  mesh.frustumCulled = false;
  const own = new THREE.Color(colour),
    matrix = new THREE.Matrix4();
  for (let i = 0; i < count; i++) {
    const node = only ? only[i] : i;
    mesh.setMatrixAt(i, slabs ? discMatrix(level, node, matrix) : ballMatrix(level, node, matrix));
    mesh.setColorAt(i, touched.has(node) ? touchedColour : own);
  }
  return mesh;
}

/** @param {THREE.Object3D} group */
export function clearBalls(group) {
  for (const child of [...group.children]) {
    if (child instanceof THREE.InstancedMesh) {
      /** @type {THREE.Material} */ (child.material).dispose();
      child.dispose();
    }
    group.remove(child);
  }
}

/**
 * @param {Level} level
 * @param {number} node
 * @param {THREE.Matrix4} matrix
 */
function ballMatrix({centres, radii}, node, matrix) {
  const radius = radii[node];
  return matrix.makeScale(radius, radius, radius).setPosition(centres[3 * node], centres[3 * node + 1], centres[3 * node + 2]);
}

const axis = new THREE.Vector3(0, 0, 1),
  normal = new THREE.Vector3(),
  centre = new THREE.Vector3();
const turn = new THREE.Quaternion(),
  scale = new THREE.Vector3();

/**
 * @param {Level} level
 * @param {number} node
 * @param {THREE.Matrix4} matrix
 */
function discMatrix({centres, radii, normals, offsets, halves}, node, matrix) {
  if (!normals || !offsets || !halves) return matrix;
  normal.fromArray(normals, 3 * node);
  if (normal.lengthSq() === 0) return ballMatrix({centres, radii}, node, matrix);
  centre.fromArray(centres, 3 * node).addScaledVector(normal, offsets[node]);
  turn.setFromUnitVectors(axis, normal.normalize());
  const reach = Math.sqrt(Math.max(0, radii[node] ** 2 - offsets[node] ** 2));
  // A slab without thickness would be drawn as nothing.
  scale.set(reach, reach, Math.max(2 * halves[node], 0.02 * radii[node]));
  return matrix.compose(centre, turn, scale);
}
