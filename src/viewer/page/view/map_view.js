/** The map on both bodies: its colours, grey where it is of another pose, and the opened book. */

import * as THREE from 'three';

import {middleOf} from '../body_box.js';
import {inverse, transformed} from '../pose.js';

/** @typedef {import('../context.js').Store} Store */
/** @typedef {import('../context.js').BiteAt} BiteAt */
/** @typedef {import('../protocol.js').Pose} Pose */
/** @typedef {import('../protocol.js').Role} Role */
/** @typedef {import('./stage.js').Stage} Stage */

/** @type {Role[]} */
const roles = ['fixed', 'moving'];
const dotColour = 0x111111;

/**
 * @param {Stage} stage
 * @param {Store} store
 * @returns {{show: (on: boolean) => void, flyTo: (role: Role, point: number[]) => void}}
 */
export function makeMapView(stage, store) {
  const dots = new THREE.Group();
  const material = new THREE.MeshBasicMaterial({color: dotColour, depthTest: false, transparent: true});
  const dot = new THREE.SphereGeometry(1, 12, 8);
  stage.fixedFrame.add(dots);
  let seen = false,
    opened = false;

  const colour = () => {
    const {bite, pose} = store.get();
    for (const role of roles) {
      const colours = seen && bite ? bite[role].colours : null;
      stage.colour(role, colours && bite?.pose !== pose ? greyed(colours) : colours);
    }
    placeDots();
  };
  const arrange = () => {
    const {bite, book} = store.get();
    const wanted = seen && book && bite !== null;
    for (const role of roles) stage.place(role, wanted ? bite[role].place : null);
    if (wanted && !opened) stage.fit(stage.bounds(), viewer(bite));
    if (!wanted && opened) stage.frameAll();
    opened = wanted;
    placeDots();
  };

  /** @param {BiteAt} bite */
  const viewer = ({pose, fixed}) => {
    const {bodies} = store.get();
    const from = middleOf(bodies.fixed),
      to = transformed(pose, middleOf(bodies.moving));
    const way = to.map((value, axis) => value - from[axis]);
    const axis = way.reduce((best, value, at) => (Math.abs(value) > Math.abs(way[best]) ? at : best), 0);
    const facing = [0, 0, 0];
    facing[axis] = Math.sign(way[axis]) || 1;
    return rotated(fixed.place, facing);
  };

  /**
   * @param {BiteAt} bite
   * @param {Role} role
   * @param {number[]} point  fixed coordinates at the bite's pose
   * @returns {number[]} where it is drawn
   */
  const drawnAt = (bite, role, point) => {
    const toOwn = role === 'fixed' ? null : inverse(bite.pose);
    const own = toOwn ? transformed(toOwn, point) : point;
    if (opened) return transformed(bite[role].place, own);
    return role === 'fixed' ? own : transformed(store.get().pose, own);
  };
  const placeDots = () => {
    const {bite, bodies, pose} = store.get();
    dots.clear();
    if (!seen || !bite || bite.pose !== pose) return stage.render();
    const radius = 0.0035 * (bodies.moving?.extent ?? 1);
    for (const role of roles) {
      for (const region of bite.bite[role].regions) {
        const mark = new THREE.Mesh(dot, material);
        mark.position.set(...threeOf(drawnAt(bite, role, region.closest)));
        mark.scale.setScalar(radius);
        mark.renderOrder = 3;
        // Closed, the bodies hide their contacts, and only the fixed body's are marked.
        if (opened || role === 'fixed') dots.add(mark);
      }
    }
    stage.render();
  };

  store.subscribe(['bite', 'book'], () => {
    colour();
    arrange();
  });
  let wasStale = false;
  store.subscribe(['pose'], ({bite, pose}) => {
    const stale = bite !== null && bite.pose !== pose;
    if (stale !== wasStale) colour();
    wasStale = stale;
  });
  return {
    show(on) {
      seen = on;
      colour();
      arrange();
    },
    flyTo(role, point) {
      const {bite} = store.get();
      if (!bite) return;
      const at = drawnAt(bite, role, point);
      stage.flyTo(at);
    },
  };
}

/**
 * @param {Pose} place
 * @param {number[]} direction
 */
function rotated(place, direction) {
  const turn = [...place];
  turn[12] = turn[13] = turn[14] = 0;
  return transformed(turn, direction);
}

/**
 * @param {number[]} numbers
 * @returns {[number, number, number]}
 */
function threeOf([x, y, z]) {
  return [x, y, z];
}

/**
 * @param {Uint8Array} colours
 * @returns {Uint8Array} the same by their lightness alone, and nearer to each other
 */
function greyed(colours) {
  const grey = new Uint8Array(colours.length);
  for (let i = 0; i + 2 < colours.length; i += 3) {
    const light = 0.3 * colours[i] + 0.59 * colours[i + 1] + 0.11 * colours[i + 2];
    grey.fill(90 + 0.4 * light, i, i + 3);
  }
  return grey;
}
