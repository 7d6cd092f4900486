/** The map on both bodies: its bands, grey where it is of another pose, the opened book, and the contacts by their numbers. */

import * as THREE from 'three';

import {inverse, transformed} from '../pose.js';
import {makeLabel, uncovered} from './label.js';
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
const dotColour = 0x111111,
  chosenColour = 0xd55e00;
/** More numbers would hide the map. */
const mostNumbers = 40;
/** Of a number, as a part of the picture's height at a distance of 1. */
const numberHeight = 0.021;

/**
 * @param {Stage} stage
 * @param {Store} store
 * @returns {{show: (on: boolean) => void, choose: (contact: number, role: Role | null) => void, home: () => void}}
 */
export function makeMapView(stage, store) {
  const dots = new THREE.Group();
  const [material, chosenMaterial] = [dotColour, chosenColour].map(
    (color) => new THREE.MeshBasicMaterial({color, depthTest: false, transparent: true}),
  );
  const dot = new THREE.SphereGeometry(1, 12, 8);
  stage.fixedFrame.add(dots);
  let seen = false,
    opened = false,
    layout = layouts[0],
    chosen = 0;
  /** @type {Map<string, THREE.SpriteMaterial>} */
  const numbers = new Map();
  /** The numbers that are placed, the most important first. @type {{sprite: THREE.Sprite, text: string}[]} */
  let placed = [];
  /** @param {number} contact */
  const numberOf = (contact) => {
    const key = `${contact} ${contact === chosen}`;
    const made = numbers.get(key) ?? makeLabel(String(contact), 1, contact === chosen ? '#b34700' : '#111').material;
    numbers.set(key, made);
    made.sizeAttenuation = false;
    const sprite = new THREE.Sprite(made);
    const height = contact === chosen ? 1.5 * numberHeight : numberHeight;
    sprite.scale.set((height * 512) / 96, height, 1);
    sprite.center.set(0.5, -0.2);
    sprite.renderOrder = contact === chosen ? 6 : 5;
    return sprite;
  };

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
    placed = [];
    if (!seen || !bite || bite.pose !== pose) return stage.render();
    const radius = 0.0035 * (bodies.moving?.extent ?? 1);
    for (const role of roles) {
      for (const region of bite.bite[role].regions) {
        // Closed, the bodies hide their contacts, and only the fixed body's are marked.
        if (!opened && role !== 'fixed') continue;
        const isChosen = region.contact === chosen;
        const mark = new THREE.Mesh(dot, isChosen ? chosenMaterial : material);
        mark.position.set(...threeOf(drawnAt(bite, role, region.closest)));
        mark.scale.setScalar(isChosen ? 2 * radius : radius);
        mark.renderOrder = isChosen ? 4 : 3;
        dots.add(mark);
        if (region.contact > mostNumbers && !isChosen) continue;
        const number = numberOf(region.contact);
        number.position.copy(mark.position);
        dots.add(number);
        placed.push({sprite: number, text: String(region.contact)});
      }
    }
    const rank = (/** @type {{text: string}} */ {text}) => (Number(text) === chosen ? 0 : Number(text));
    placed.sort((a, b) => rank(a) - rank(b));
    stage.render();
  };
  // A number that covers another one could be read as a third one.
  const hideCovered = () => {
    const {camera} = stage;
    if (!(camera instanceof THREE.PerspectiveCamera) || placed.length === 0) return;
    camera.updateMatrixWorld();
    const scale = camera.projectionMatrix.elements[5];
    const free = uncovered(
      placed.map(({sprite, text}) => {
        const at = sprite.getWorldPosition(new THREE.Vector3()).project(camera),
          height = 0.75 * scale * sprite.scale.y;
        return {x: camera.aspect * at.x, y: at.y, width: 0.62 * height * text.length, height: 0.9 * height};
      }),
    );
    placed.forEach(({sprite}, i) => (sprite.visible = free[i]));
  };
  stage.beforeFrame(hideCovered);

  store.subscribe(['bite', 'book'], ({bite}) => {
    if (!bite || bite.bite.contacts.length < chosen) chosen = 0;
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
    choose(contact, role) {
      const {bite} = store.get();
      if (!bite) return;
      chosen = contact;
      placeDots();
      // Opened, both its marks are seen; closed, one looks at its mark on the fixed body.
      const on = role ?? (opened ? null : 'fixed');
      const region = on && bite.bite[on].regions[bite.bite.contacts[contact - 1][on][0]];
      if (on && region) stage.flyTo(drawnAt(bite, on, region.closest));
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
