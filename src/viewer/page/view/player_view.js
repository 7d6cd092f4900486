/** A recording in the picture: the hand apart from the tool, the other bodies, and the contact points. */

import * as THREE from 'three';

import {makeBodyMesh} from './body_mesh.js';
import {makePointArrows} from './point_arrows.js';

/** @typedef {import('../protocol.js').BodyFacts} BodyFacts */
/** @typedef {import('../protocol.js').Pose} Pose */
/** @typedef {import('./stage.js').Stage} Stage */
/** @typedef {import('./body_mesh.js').BodyMesh} BodyMesh */

/**
 * @typedef {object} PlayerView
 * @property {(moving: BodyFacts | null, others: BodyFacts[], size: number) => void} set  null: frames alone are drawn
 * @property {(hand: Pose | null, places: Pose[]) => void} placeBodies  in the picture's coordinates
 * @property {(tool: Pose, hand: Pose | null) => void} placeFrames
 * @property {(arrows: import('../recording/points.js').Arrow[]) => void} placePoints  before bodies or frames, which draw
 * @property {(path: number[]) => void} setPath  of the tool's frame: three numbers a point
 * @property {() => void} clear
 */

const handColour = 0xcc79a7,
  otherColour = 0xb9c2a8,
  pathColour = 0x0072b2;

/**
 * @param {Stage} stage
 * @returns {PlayerView}
 */
export function makePlayerView(stage) {
  const group = new THREE.Group(),
    pointGroup = new THREE.Group();
  stage.fixedFrame.add(group, pointGroup);
  const points = makePointArrows(pointGroup);
  let extent = 1;
  /** @type {BodyMesh | null} */
  let hand = null;
  /** @type {BodyMesh[]} */
  let others = [];
  const toolFrame = frame(0.12),
    handFrame = frame(0.08);
  const path = new THREE.Line(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({color: pathColour}));
  path.frustumCulled = false;
  const empty = () => {
    group.clear();
    for (const each of hand ? [hand, ...others] : others) each.dispose();
    hand = null;
    others = [];
    points.set([], extent);
  };
  return {
    set(moving, drawn, size) {
      empty();
      extent = size;
      if (!moving) {
        for (const each of [toolFrame, handFrame]) each.scale.setScalar(size);
        group.add(toolFrame, handFrame, path);
        return;
      }
      hand = makeBodyMesh(handColour);
      hand.setFacts(moving);
      hand.fade(0.3);
      others = drawn.map((facts) => {
        const mesh = makeBodyMesh(otherColour);
        mesh.setFacts(facts);
        return mesh;
      });
      group.add(hand.object, ...others.map((each) => each.object));
    },
    placeBodies(handPose, places) {
      if (hand) hand.object.visible = handPose !== null;
      if (handPose) hand?.setMatrix(handPose);
      for (const [at, place] of places.entries()) others[at]?.setMatrix(place);
      stage.render();
    },
    placeFrames(tool, handPose) {
      put(toolFrame, tool);
      handFrame.visible = handPose !== null;
      if (handPose) put(handFrame, handPose);
      stage.render();
    },
    placePoints(arrows) {
      points.set(arrows, extent);
    },
    setPath(places) {
      path.geometry.setAttribute('position', new THREE.Float32BufferAttribute(places, 3));
      path.geometry.computeBoundingSphere();
    },
    clear() {
      empty();
      stage.render();
    },
  };
}

/** @param {number} length */
function frame(length) {
  const made = new THREE.Group();
  made.add(new THREE.AxesHelper(length));
  return made;
}

/**
 * @param {THREE.Group} object
 * @param {Pose} pose
 */
function put(object, pose) {
  const matrix = new THREE.Matrix4().fromArray(pose);
  object.position.setFromMatrixPosition(matrix);
  object.quaternion.setFromRotationMatrix(matrix);
}
