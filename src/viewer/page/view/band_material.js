/** The material of a distance map: the shader finds each pixel's band by the distance between the vertices. */

import * as THREE from 'three';

/**
 * @typedef {object} DrawnBand
 * @property {number} to
 * @property {string} colour  "#rrggbb"
 * @property {boolean} hatched
 */

/**
 * @typedef {object} DrawnMap
 * @property {Float32Array} distances  of each vertex; NaN beyond the reach
 * @property {DrawnBand[]} bands       by distance, without gaps
 * @property {string} bare             colour of what lies beyond the bands
 */

const most = 16;
// As the legend's swatches: a line of 1.5 pixels in 5, of black that covers 55 %.
const cover = 0.55;

const inVertex = {declared: 'attribute float mapDistance; varying float vMapDistance;', done: 'vMapDistance = mapDistance;'};
const inFragment = {
  declared: `
    varying float vMapDistance;
    uniform float bandEnds[${most}];
    uniform vec3 bandColours[${most}], lineColours[${most}], bareColour;
    uniform float dotsInPixel;
    vec3 mapColour() {
      float across = mod((gl_FragCoord.x + gl_FragCoord.y) * 0.70710678 / dotsInPixel, 5.0);
      for (int band = 0; band < ${most}; band++) {
        if (vMapDistance <= bandEnds[band]) return across < 1.5 ? lineColours[band] : bandColours[band];
      }
      return bareColour;
    }`,
  done: 'diffuseColor.rgb = mapColour();',
};

/**
 * @param {THREE.MeshStandardMaterialParameters} look
 * @returns {{material: THREE.Material, set: (map: DrawnMap) => void}}  the mesh needs the attribute `mapDistance`
 */
export function makeBandMaterial(look) {
  const colours = () => Array.from({length: most}, () => new THREE.Color());
  const uniforms = {
    // Unused bands end below every distance.
    bandEnds: {value: new Array(most).fill(-1e30)},
    bandColours: {value: colours()},
    lineColours: {value: colours()},
    bareColour: {value: new THREE.Color()},
    dotsInPixel: {value: 1},
  };
  const material = new THREE.MeshStandardMaterial(look);
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, uniforms);
    shader.vertexShader = added(shader.vertexShader, 'begin_vertex', inVertex);
    shader.fragmentShader = added(shader.fragmentShader, 'color_fragment', inFragment);
  };
  return {
    material,
    set({bands, bare}) {
      uniforms.bareColour.value.set(bare);
      uniforms.dotsInPixel.value = Math.min(devicePixelRatio, 2);
      for (let at = 0; at < most; at++) {
        const band = bands[at];
        uniforms.bandEnds.value[at] = band ? band.to : -1e30;
        if (!band) continue;
        uniforms.bandColours.value[at].set(band.colour);
        uniforms.lineColours.value[at].set(band.hatched ? covered(band.colour) : band.colour);
      }
    },
  };
}

/**
 * @param {string} source  of a shader
 * @param {string} after   the part of it that is followed by ours
 * @param {{declared: string, done: string}} ours
 */
function added(source, after, {declared, done}) {
  const parts = {common: declared, [after]: done};
  return Object.entries(parts).reduce((text, [name, ours]) => text.replace(`#include <${name}>`, `#include <${name}>\n${ours}`), source);
}

/**
 * @param {string} colour  "#rrggbb"
 * @returns {string} below a hatching line, mixed as a browser mixes
 */
function covered(colour) {
  const parts = [1, 3, 5].map((at) => Math.round((1 - cover) * parseInt(colour.slice(at, at + 2), 16)));
  return `rgb(${parts.join(', ')})`;
}
