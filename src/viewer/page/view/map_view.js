/** The map on both bodies: its bands, grey where it is of another pose, and the opened book. */

import * as THREE from 'three';

import {inverse, transformed} from '../pose.js';
import {threeOf} from './stage.js';

/** @typedef {import('../context.js').Store} Store */
/** @typedef {import('../context.js').BiteAt} BiteAt */
/** @typedef {import('../protocol.js').Role} Role */
/** @typedef {import('./stage.js').Stage} Stage */

/** @type {Role[]} */
const roles = ['fixed', 'moving'];
/** @type {import('../protocol.js').BookLayout[]} */
const layouts = ['beside', 'above'];
const viewer = [0, -1, 0];
const dotColour = 0x111111;

/**
 * @param {Stage} stage
 * @param {Store} store
 * @returns {{show: (on: boolean) => void, flyTo: (role: Role, point: number[]) => void, home: () => void}}
 */
export function makeMapView(stage, store) {
  const dots = new THREE.Group();
  const material = new THREE.MeshBasicMaterial({color: dotColour, depthTest: false, transparent: true});
  const dot = new THREE.SphereGeometry(1, 12, 8);
  stage.fixedFrame.add(dots);
  let seen = false,
    opened = false,
    layout = layouts[0];

  const colour = () => {
    const {bite, pose} = store.get();
    for (const role of roles) stage.map(role, seen && bite ? drawnMap(bite, role, bite.pose !== pose) : null);
    placeDots();
  };
  /** @param {BiteAt} bite */
  const lay = (bite) => {
    for (const role of roles) stage.place(role, bite.book[layout][role]);
  };
  /** Lays both bodies side by side or above each other, whatever is seen larger, and looks at them. */
  const lookAtBook = () => {
    const {bite} = store.get();
    if (!opened || !bite) return;
    const reached = layouts.map((each) => {
      layout = each;
      lay(bite);
      return stage.reach(stage.bounds(), viewer);
    });
    layout = layouts[reached[0] <= reached[1] ? 0 : 1];
    lay(bite);
    placeDots();
    stage.fit(stage.bounds(), viewer);
  };
  const arrange = () => {
    const {bite, book, facing} = store.get();
    const before = opened;
    opened = seen && book && bite !== null;
    if (opened !== before) {
      stage.setHome(opened ? lookAtBook : null);
      // The opened book has its own coordinates.
      if (opened) stage.setUpright([0, 0, 1], viewer);
      else stage.setUpright(facing.up, facing.front);
    }
    if (opened && bite) lay(bite);
    else for (const role of roles) stage.place(role, null);
    if (opened && !before) lookAtBook();
    if (!opened && before) stage.frameAll();
    placeDots();
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
    if (opened) return transformed(bite.book[layout][role], own);
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
  stage.onResize(lookAtBook);
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
    home: lookAtBook,
    flyTo(role, point) {
      const {bite} = store.get();
      if (!bite) return;
      const at = drawnAt(bite, role, point);
      stage.flyTo(at);
    },
  };
}

/**
 * @param {BiteAt} bite
 * @param {Role} role
 * @param {boolean} stale  whether it is drawn by its lightness alone
 * @returns {import('./band_material.js').DrawnMap}
 */
function drawnMap({bands, bare, ...bite}, role, stale) {
  const shown = stale ? greyed : (/** @type {string} */ colour) => colour;
  return {
    distances: bite[role].distances,
    bands: bands.map(({to, colour, below_scan_error: hatched}) => ({to, colour: shown(colour), hatched})),
    bare: shown(bare),
  };
}

/**
 * @param {string} colour  "#rrggbb"
 * @returns {string} the same by its lightness alone, and nearer to the others
 */
function greyed(colour) {
  const [red, green, blue] = [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));
  const grey = Math.round(90 + 0.4 * (0.3 * red + 0.59 * green + 0.11 * blue));
  return `#${grey.toString(16).padStart(2, '0').repeat(3)}`;
}
