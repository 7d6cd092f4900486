/** The stage of a browser that draws nothing in 3D: the numbers are all there. */

import {Box3, Camera, Group} from 'three';

/** @typedef {import('./stage.js').Stage} Stage */

/** @returns {boolean} */
export function canDraw() {
  return document.createElement('canvas').getContext('webgl2') !== null;
}

/**
 * @param {HTMLElement} surface
 * @returns {Stage}
 */
export function makeNoStage(surface) {
  const nothing = () => {};
  return {
    drawn: false,
    fixedFrame: new Group(), movingFrame: new Group(), camera: new Camera(), surface,
    render: nothing, setBody: nothing, setPose: nothing, colour: nothing, fade: nothing, place: nothing,
    flyTo: nothing, fit: nothing, frameAll: nothing, circle: nothing, bounds: () => new Box3(), orbit: nothing, setBackground: nothing,
    picture: () => Promise.reject(new Error('This browser draws nothing in 3D (it has no WebGL2), so there is no picture to save: open the page in another browser.')),
  };
}
