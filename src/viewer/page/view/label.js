/** A line of text in the scene, which always faces the viewer. */

import * as THREE from 'three';

/** @typedef {{x: number, y: number, width: number, height: number}} Box  its middle and its sides, in one unit */

/**
 * Tells which boxes no box before them meets, of those that are drawn.
 * @param {Box[]} boxes
 * @returns {boolean[]}
 */
export function uncovered(boxes) {
  /** @type {Box[]} */
  const drawn = [];
  return boxes.map((box) => {
    const free = drawn.every(
      (other) => Math.abs(box.x - other.x) >= (box.width + other.width) / 2 || Math.abs(box.y - other.y) >= (box.height + other.height) / 2,
    );
    if (free) drawn.push(box);
    return free;
  });
}

/** @param {THREE.Sprite} label  is not drawn again */
export function disposeLabel({material}) {
  material.map?.dispose();
  material.dispose();
}

/**
 * @param {string} text
 * @param {number} height  mesh units
 * @param {string} [colour]
 * @returns {THREE.Sprite}
 */
export function makeLabel(text, height, colour = '#222') {
  const canvas = document.createElement('canvas');
  [canvas.width, canvas.height] = [512, 96];
  const pen = canvas.getContext('2d');
  if (pen) {
    pen.font = '600 64px sans-serif';
    pen.textAlign = 'center';
    pen.textBaseline = 'middle';
    pen.lineWidth = 10;
    pen.strokeStyle = 'white';
    pen.strokeText(text, 256, 48);
    pen.fillStyle = colour;
    pen.fillText(text, 256, 48);
  }
  const map = new THREE.CanvasTexture(canvas);
  map.colorSpace = THREE.SRGBColorSpace;
  const sprite = new THREE.Sprite(new THREE.SpriteMaterial({map, depthTest: false}));
  sprite.scale.set((height * 512) / 96, height, 1);
  sprite.renderOrder = 5;
  return sprite;
}
