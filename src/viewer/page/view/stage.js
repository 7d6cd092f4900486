/**
 * The 3D view: both bodies, a camera that circles them, and frames for the marks of panels. It draws
 * only when something changed.
 */

import * as THREE from 'three';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';

import {identity} from '../pose.js';
import {makeBodyMesh} from './body_mesh.js';

/** @typedef {import('../protocol.js').Pose} Pose */
/** @typedef {import('../protocol.js').Role} Role */
/** @typedef {import('../protocol.js').BodyFacts} BodyFacts */
/** @typedef {import('./band_material.js').DrawnMap} DrawnMap */

/**
 * @typedef {object} Stage
 * @property {boolean} drawn            false: this browser draws nothing, and all else is silent
 * @property {THREE.Group} fixedFrame   for marks in fixed coordinates
 * @property {THREE.Group} movingFrame  for marks in moving coordinates
 * @property {THREE.Camera} camera
 * @property {HTMLElement} surface      what the pointer touches
 * @property {() => void} render        draws a frame soon; many calls draw one
 * @property {(listen: () => void) => void} beforeFrame  calls before each frame
 * @property {(role: Role, facts: BodyFacts | null) => void} setBody
 * @property {(pose: Pose) => void} setPose
 * @property {(role: Role, map: DrawnMap | null) => void} map  null: the body's own colour
 * @property {(role: Role, opacity: number) => void} fade  1: solid; 0: not drawn
 * @property {(role: Role, place: Pose | null) => void} place  draws a body elsewhere than at its pose
 * @property {(point: number[], from?: number[], distance?: number) => void} flyTo  looks at a point, fixed coordinates, from a direction
 * @property {(box: THREE.Box3, from: number[]) => void} fit  looks at all of a box
 * @property {(box: THREE.Box3, from: number[]) => number} reach  from how far fit() looks
 * @property {() => void} frameAll     looks at both bodies, from in front
 * @property {() => void} home         looks as setHome() says, else at both bodies
 * @property {(view: (() => void) | null) => void} setHome
 * @property {(up: number[], front: number[]) => void} setUpright  which ways are up and to the front; fixed coordinates
 * @property {(listen: () => void) => void} onResize
 * @property {(across: number, up: number, nearer: number) => void} circle  turns the camera by angles, and scales its distance
 * @property {() => THREE.Box3} bounds of both bodies as drawn
 * @property {(on: boolean) => void} orbit  whether the pointer turns the camera
 * @property {(background: string) => void} setBackground
 * @property {() => Promise<Blob>} picture  PNG of the canvas
 */

// The direction from the bodies to the camera in the front view: right, front, up.
const seenFrom = [0.35, 1, 0.22];
const ownColours = {fixed: 0xd9c6a0, moving: 0x86aed6};

/**
 * Throws where the browser draws nothing after all.
 * @param {HTMLElement} surface
 * @param {(text: string, kind: 'note' | 'warning') => void} say
 * @returns {Stage}
 */
export function makeStage(surface, say) {
  const renderer = new THREE.WebGLRenderer({antialias: true});
  renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
  surface.append(renderer.domElement);
  const scene = new THREE.Scene();
  const camera = new THREE.PerspectiveCamera(35, 1, 1, 1e4);
  camera.up.set(0, 0, 1);
  const sky = new THREE.HemisphereLight(0xffffff, 0x8a8a96, 1.7);
  sky.position.set(0, 0, 1);
  // The lamp goes with the viewer, so that what is looked at is lit.
  const lamp = new THREE.DirectionalLight(0xffffff, 1.7);
  lamp.position.set(0.35, 0.5, 1);
  camera.add(lamp, lamp.target);
  scene.add(camera, sky);
  const fixedFrame = new THREE.Group(),
    movingFrame = new THREE.Group();
  movingFrame.matrixAutoUpdate = false;
  scene.add(fixedFrame, movingFrame);
  const bodies = {
    fixed: makeBodyMesh(ownColours.fixed),
    moving: makeBodyMesh(ownColours.moving),
  };
  scene.add(bodies.fixed.object, bodies.moving.object);

  let front = new THREE.Vector3(0, -1, 0);
  // The controls take the way up when they are made.
  const makeControls = () => {
    const made = new OrbitControls(camera, renderer.domElement);
    made.enableDamping = false;
    made.addEventListener('change', () => render());
    return made;
  };
  let controls = makeControls();

  renderer.domElement.addEventListener('webglcontextlost', () => {
    say(
      'The picture stands still: the browser took its memory for graphics away. All numbers go on. If the picture does not come back, load the page again.',
      'warning',
    );
  });
  renderer.domElement.addEventListener('webglcontextrestored', () => {
    say('The picture is back.', 'note');
    render();
  });

  let waits = false;
  /** @type {(() => void)[]} */
  const beforeFrame = [];
  const draw = () => {
    waits = false;
    for (const listen of beforeFrame) listen();
    renderer.render(scene, camera);
  };
  const render = () => {
    if (waits) return;
    waits = true;
    requestAnimationFrame(draw);
  };

  /** @type {Pose} */
  let pose = [...identity];
  /** @type {{fixed: Pose | null, moving: Pose | null}} */
  const places = {fixed: null, moving: null};
  const arrange = () => {
    movingFrame.matrix.fromArray(pose);
    movingFrame.matrixWorldNeedsUpdate = true;
    bodies.fixed.setMatrix(places.fixed ?? [...identity]);
    bodies.moving.setMatrix(places.moving ?? pose);
    render();
  };

  const bounds = () => {
    const box = new THREE.Box3();
    for (const body of [bodies.fixed, bodies.moving]) box.union(body.bounds());
    return box;
  };
  /**
   * @param {THREE.Vector3} at
   * @param {THREE.Vector3} from
   * @param {number} distance
   */
  const look = (at, from, distance) => {
    controls.target.copy(at);
    camera.position.copy(at).addScaledVector(from.normalize(), distance);
    controls.update();
    render();
  };

  /** @type {(() => void) | null} */
  let homeView = null;
  /** @type {(() => void)[]} */
  const resized = [];
  new ResizeObserver(() => {
    const {clientWidth, clientHeight} = surface;
    if (clientWidth === 0 || clientHeight === 0) return;
    renderer.setSize(clientWidth, clientHeight, false);
    camera.aspect = clientWidth / clientHeight;
    camera.updateProjectionMatrix();
    for (const listen of resized) listen();
    draw();
  }).observe(surface);

  return {
    drawn: true,
    fixedFrame,
    movingFrame,
    camera,
    surface: renderer.domElement,
    render,
    beforeFrame: (listen) => void beforeFrame.push(listen),
    bounds,
    setBody(role, facts) {
      bodies[role].setFacts(facts);
      render();
    },
    setPose(to) {
      pose = to;
      arrange();
    },
    map(role, map) {
      bodies[role].setMap(map);
      render();
    },
    fade(role, opacity) {
      bodies[role].fade(opacity);
      render();
    },
    place(role, place) {
      places[role] = place;
      arrange();
    },
    flyTo(point, from, distance) {
      const direction = from ? new THREE.Vector3(...from) : camera.position.clone().sub(controls.target);
      look(new THREE.Vector3(...point), direction, distance ?? bounds().getSize(new THREE.Vector3()).length() * 0.35);
    },
    reach: (box, from) => distanceOf(box, new THREE.Vector3(...from).normalize(), camera),
    fit(box, from) {
      if (box.isEmpty()) return;
      const size = box.getSize(new THREE.Vector3()).length();
      camera.near = size / 1000;
      camera.far = size * 30;
      camera.updateProjectionMatrix();
      const direction = new THREE.Vector3(...from).normalize();
      look(box.getCenter(new THREE.Vector3()), direction, distanceOf(box, direction, camera));
    },
    frameAll() {
      const axes = [new THREE.Vector3().crossVectors(camera.up, front), front, camera.up];
      const from = axes.reduce((sum, axis, at) => sum.addScaledVector(axis, seenFrom[at]), new THREE.Vector3());
      this.fit(bounds(), from.toArray());
    },
    home() {
      if (homeView) homeView();
      else this.frameAll();
    },
    setHome(view) {
      homeView = view;
    },
    setUpright(up, to) {
      front = new THREE.Vector3(...to);
      const before = camera.up.clone();
      if (before.distanceTo(camera.up.set(...threeOf(up)).normalize()) === 0) return;
      sky.position.copy(camera.up);
      const {target, enabled} = controls;
      controls.dispose();
      controls = makeControls();
      controls.enabled = enabled;
      controls.target.copy(target);
      controls.update();
      render();
    },
    onResize(listen) {
      resized.push(listen);
    },
    circle(across, up, nearer) {
      const toY = new THREE.Quaternion().setFromUnitVectors(camera.up, new THREE.Vector3(0, 1, 0));
      const arm = new THREE.Spherical().setFromVector3(camera.position.clone().sub(controls.target).applyQuaternion(toY));
      arm.set(arm.radius * nearer, Math.min(3.1, Math.max(0.04, arm.phi + up)), arm.theta + across);
      look(controls.target.clone(), new THREE.Vector3().setFromSpherical(arm).applyQuaternion(toY.invert()), arm.radius);
    },
    orbit(on) {
      controls.enabled = on;
    },
    setBackground(background) {
      scene.background = new THREE.Color(background);
      render();
    },
    picture() {
      draw();
      return new Promise((resolve, reject) => {
        renderer.domElement.toBlob(
          (blob) => (blob ? resolve(blob) : reject(new Error('The browser made no picture: make its window smaller.'))),
          'image/png',
        );
      });
    },
  };
}

/**
 * @param {THREE.Box3} box
 * @param {THREE.Vector3} from  of length 1
 * @param {THREE.PerspectiveCamera} camera
 * @returns {number} from the box's middle, so that all of it is seen
 */
function distanceOf(box, from, camera) {
  const right = new THREE.Vector3().crossVectors(camera.up, from).normalize();
  if (right.lengthSq() === 0) right.set(1, 0, 0);
  const up = new THREE.Vector3().crossVectors(from, right);
  const middle = box.getCenter(new THREE.Vector3()),
    slope = Math.tan((camera.fov * Math.PI) / 360);
  let distance = 0;
  for (const x of [box.min.x, box.max.x]) {
    for (const y of [box.min.y, box.max.y]) {
      for (const z of [box.min.z, box.max.z]) {
        const corner = new THREE.Vector3(x, y, z).sub(middle);
        const across = Math.max(Math.abs(corner.dot(up)), Math.abs(corner.dot(right)) / camera.aspect);
        distance = Math.max(distance, (1.03 * across) / slope + corner.dot(from));
      }
    }
  }
  return distance;
}

/**
 * @param {number[]} numbers
 * @returns {[number, number, number]}
 */
export function threeOf([x, y, z]) {
  return [x, y, z];
}
