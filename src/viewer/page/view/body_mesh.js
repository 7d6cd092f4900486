/** A body as drawn: its triangles, in its own colour or in those of a map. */

import * as THREE from 'three';

import {identity} from '../pose.js';

/** @typedef {import('../protocol.js').BodyFacts} BodyFacts */
/** @typedef {import('../protocol.js').Pose} Pose */

/**
 * @typedef {object} BodyMesh
 * @property {THREE.Object3D} object
 * @property {(facts: BodyFacts | null) => void} setFacts
 * @property {(colours: Uint8Array | null) => void} setColours
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
  const material = new THREE.MeshStandardMaterial({color: ownColour, roughness: 0.65, metalness: 0, side: THREE.DoubleSide});
  const mesh = new THREE.Mesh(new THREE.BufferGeometry(), material);
  mesh.matrixAutoUpdate = false;
  mesh.matrix.fromArray([...identity]);
  mesh.visible = false;
  let faded = 1,
    known = false;
  const show = () => {
    mesh.visible = known && faded > 0;
  };
  return {
    object: mesh,
    setFacts(facts) {
      mesh.geometry.dispose();
      mesh.geometry = new THREE.BufferGeometry();
      known = facts !== null;
      show();
      if (!facts) return;
      mesh.geometry.setAttribute('position', new THREE.BufferAttribute(facts.positions, 3));
      mesh.geometry.setIndex(new THREE.BufferAttribute(facts.triangles, 1));
      mesh.geometry.computeVertexNormals();
      mesh.geometry.computeBoundingBox();
      mesh.geometry.computeBoundingSphere();
      this.setColours(null);
    },
    setColours(colours) {
      const fits = colours !== null && colours.length === mesh.geometry.getAttribute('position')?.array.length;
      if (fits) mesh.geometry.setAttribute('color', new THREE.BufferAttribute(linear(colours), 3, true));
      else mesh.geometry.deleteAttribute('color');
      material.vertexColors = fits;
      material.color.set(fits ? 0xffffff : ownColour);
      material.needsUpdate = true;
    },
    fade(opacity) {
      faded = opacity;
      material.transparent = opacity < 1;
      material.opacity = opacity;
      material.depthWrite = opacity >= 1;
      material.needsUpdate = true;
      show();
    },
    setMatrix(pose) {
      mesh.matrix.fromArray(pose);
      mesh.matrixWorldNeedsUpdate = true;
    },
    bounds: () => (known && mesh.geometry.boundingBox ? mesh.geometry.boundingBox.clone().applyMatrix4(mesh.matrix) : new THREE.Box3()),
    dispose() {
      mesh.geometry.dispose();
      material.dispose();
    },
  };
}

/** Screen colours by the light that they stand for, of 255: what the renderer takes. */
const byLight = Uint8Array.from({length: 256}, (_, value) =>
  Math.round(255 * new THREE.Color().setRGB(value / 255, 0, 0, THREE.SRGBColorSpace).r),
);

/** @param {Uint8Array} colours */
function linear(colours) {
  return colours.map((value) => byLight[value]);
}
