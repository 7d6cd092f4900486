/** A body as drawn: its triangles, in its own colour or in the bands of a map. */

import * as THREE from 'three';

import {identity} from '../pose.js';
import {makeBandMaterial} from './band_material.js';
import {mappedFirst} from './mapped_triangles.js';

/** @typedef {import('../protocol.js').BodyFacts} BodyFacts */
/** @typedef {import('../protocol.js').Pose} Pose */
/** @typedef {import('./band_material.js').DrawnMap} DrawnMap */

/**
 * @typedef {object} BodyMesh
 * @property {THREE.Object3D} object
 * @property {(facts: BodyFacts | null) => void} setFacts
 * @property {(map: DrawnMap | null) => void} setMap  null, or of another mesh: its own colour
 * @property {(opacity: number) => void} fade
 * @property {(pose: Pose) => void} setMatrix
 * @property {() => THREE.Box3} bounds
 * @property {() => void} dispose  gives the picture's memory back; it is not drawn again
 */

/**
 * @param {number} ownColour
 * @returns {BodyMesh}
 */
export function makeBodyMesh(ownColour) {
  const look = {roughness: 0.65, metalness: 0, side: THREE.DoubleSide};
  const plain = new THREE.MeshStandardMaterial(look),
    banded = makeBandMaterial(look);
  const materials = [plain, banded.material];
  const mesh = new THREE.Mesh(new THREE.BufferGeometry(), materials);
  /** @type {BodyFacts | null} */
  let shown = null;
  /** @type {Float32Array | null} */
  let mapped = null;
  mesh.matrixAutoUpdate = false;
  mesh.matrix.fromArray([...identity]);
  mesh.visible = false;
  let faded = 1,
    known = false;
  const show = () => {
    mesh.visible = known && faded > 0;
  };
  /**
   * @param {Uint32Array} triangles
   * @param {number} banded  how many of the indices, the first ones, are drawn in bands
   */
  const order = (triangles, banded) => {
    mesh.geometry.setIndex(new THREE.BufferAttribute(triangles, 1));
    mesh.geometry.clearGroups();
    mesh.geometry.addGroup(0, banded, 1);
    mesh.geometry.addGroup(banded, triangles.length - banded, 0);
  };
  return {
    object: mesh,
    setFacts(facts) {
      mesh.geometry.dispose();
      mesh.geometry = new THREE.BufferGeometry();
      [shown, mapped, known] = [facts, null, facts !== null];
      show();
      if (!facts) return;
      mesh.geometry.setAttribute('position', new THREE.BufferAttribute(facts.positions, 3));
      order(facts.triangles, 0);
      mesh.geometry.computeVertexNormals();
      mesh.geometry.computeBoundingBox();
      mesh.geometry.computeBoundingSphere();
      this.setMap(null);
    },
    setMap(map) {
      const known = shown !== null && map !== null && map.distances.length * 3 === shown.positions.length ? map : null;
      plain.color.set(known ? known.bare : ownColour);
      if (known) banded.set(known);
      if (shown === null || mapped === (known?.distances ?? null)) return;
      mapped = known?.distances ?? null;
      if (mapped) {
        const sorted = mappedFirst(shown.positions, shown.triangles, mapped);
        mesh.geometry.setAttribute('mapDistance', new THREE.BufferAttribute(mapped, 1));
        order(sorted.triangles, sorted.mapped);
      } else {
        mesh.geometry.deleteAttribute('mapDistance');
        order(shown.triangles, 0);
      }
    },
    fade(opacity) {
      faded = opacity;
      for (const material of materials) {
        material.transparent = opacity < 1;
        material.opacity = opacity;
        material.depthWrite = opacity >= 1;
        material.needsUpdate = true;
      }
      show();
    },
    setMatrix(pose) {
      mesh.matrix.fromArray(pose);
      mesh.matrixWorldNeedsUpdate = true;
    },
    bounds: () => (known && mesh.geometry.boundingBox ? mesh.geometry.boundingBox.clone().applyMatrix4(mesh.matrix) : new THREE.Box3()),
    dispose() {
      mesh.geometry.dispose();
      for (const material of materials) material.dispose();
    },
  };
}
