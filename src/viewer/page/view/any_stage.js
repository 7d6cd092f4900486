/** The stage, and that of a browser that draws nothing in 3D: the numbers are all there. */

import {Box3, Camera, Group} from 'three';

import {element} from '../ui/element.js';
import {makeStage} from './stage.js';

/** @typedef {import('./stage.js').Stage} Stage */

/**
 * The stage of this browser, whatever it draws.
 * @param {HTMLElement} surface
 * @param {(text: string, kind: 'note' | 'warning') => void} say
 * @returns {Stage}
 */
export function makeAnyStage(surface, say) {
  if (canDraw()) {
    try {
      return makeStage(surface, say);
    } catch {
      // A browser that has WebGL2 may still give none, as where many pages draw.
    }
  }
  surface.append(
    element(
      'p',
      {class: 'no-drawing'},
      'This browser draws nothing in 3D: it has no WebGL2, or it is switched off, or too many pages draw. All numbers are here; for the picture close other pages and load this one again, switch hardware acceleration on, or use another browser.',
    ),
  );
  return makeNoStage(surface);
}

/** @returns {boolean} */
function canDraw() {
  return document.createElement('canvas').getContext('webgl2') !== null;
}

/**
 * @param {HTMLElement} surface
 * @returns {Stage}
 */
function makeNoStage(surface) {
  const nothing = () => {};
  return {
    drawn: false,
    fixedFrame: new Group(),
    movingFrame: new Group(),
    camera: new Camera(),
    surface,
    render: nothing,
    beforeFrame: nothing,
    setBody: nothing,
    setPose: nothing,
    map: nothing,
    fade: nothing,
    place: nothing,
    flyTo: nothing,
    fit: nothing,
    reach: () => 0,
    frameAll: nothing,
    home: nothing,
    setHome: nothing,
    setUpright: nothing,
    onResize: nothing,
    circle: nothing,
    bounds: () => new Box3(),
    orbit: nothing,
    setBackground: nothing,
    picture: () =>
      Promise.reject(
        new Error('This browser draws nothing in 3D (it has no WebGL2), so there is no picture to save: open the page in another browser.'),
      ),
  };
}
