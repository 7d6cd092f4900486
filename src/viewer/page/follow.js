/**
 * Keeps the answers at the pose: touch, distance, contacts and force with every frame; the command's
 * whole answer, with the depth, and the map when the pose has come to rest.
 */

import {EngineError, faultText} from './engine/engine_client.js';
import {millimetresIn} from './words.js';

/** @typedef {import('./context.js').Context} Context */
/** @typedef {import('./context.js').State} State */
/** @typedef {import('./protocol.js').Pose} Pose */
/** @typedef {import('./protocol.js').Policy} Policy */

// A hand that pauses for less is still dragging.
const rest = 250;

/**
 * @param {Pick<Context, 'engine' | 'measurer' | 'store' | 'say'>} context
 * @returns {{settled: () => boolean}}  whether every answer is of this pose
 */
export function followPose({engine, measurer, store, say}) {
  /** @type {number | undefined} */
  let waiting;
  let asking = 0;
  /** @type {Readonly<State> | null} of which a map is measured now */
  let mapped = null;

  /** @param {Promise<void>} done */
  const counted = async (done) => {
    const {trees} = store.get();
    asking += 1;
    try {
      await done;
    } catch (error) {
      const text = faultText(error);
      // A question about trees that are gone needs no answer.
      if (text && store.get().trees === trees) say(text, 'error');
    } finally {
      asking -= 1;
    }
  };

  async function tick() {
    const {pose, policy, stiffness, trees} = store.get();
    if (!trees) return;
    const found = await engine.ask(
      'tick',
      {pose, policy: policy ?? undefined, stiffness: stiffness * perUnit(store.get())},
      {latest: true, first: true},
    );
    if (store.get().trees === trees) store.set({tick: found});
  }

  async function answer() {
    const {pose, policy, trees} = store.get();
    if (!trees) return;
    try {
      const found = await engine.ask(
        'collide',
        {pose, policy: policy ?? undefined},
        {latest: true, doing: 'Finding distance and depth', seldomLong: true},
      );
      if (store.get().trees === trees) store.set({answer: {...found, pose, policy}});
    } catch (error) {
      // Whoever cancels an answer wants no other at this pose.
      if (isCancelled(error) && store.get().trees === trees) store.set({cancelled: {pose, policy}});
      throw error;
    }
  }

  async function map() {
    const state = store.get();
    const {pose, trees} = state;
    if (!trees || !state.wantsMap || !measurable(state)) return;
    try {
      mapped = state;
      const bite = await measurer.ask('occlusion', biteQuestion(state), {latest: true, doing: 'Measuring the distances of both bodies'});
      const now = store.get();
      // A map of settings that were changed meanwhile would pass for one of theirs.
      const same = ['preset', 'reach', 'unit', 'frame'].every(
        (key) => now[/** @type {keyof State} */ (key)] === state[/** @type {keyof State} */ (key)],
      );
      if (now.trees === trees && same) store.set({bite: {...bite, pose}});
    } catch (error) {
      // Whoever cancels a map wants no other, until they ask for it.
      if (isCancelled(error)) store.set({wantsMap: false});
      throw error;
    } finally {
      if (mapped === state) mapped = null;
    }
  }

  const atRest = () => {
    waiting = undefined;
    const {dragging, pose, trees, answer: last, cancelled, bite, wantsMap} = store.get();
    if (dragging || !trees) return;
    if (!isHere(store.get(), last) && !isHere(store.get(), cancelled)) counted(answer());
    if (wantsMap && bite?.pose !== pose) counted(map());
  };
  const later = () => {
    clearTimeout(waiting);
    waiting = setTimeout(atRest, rest);
  };

  // A map of a pose that is gone would keep the next one waiting.
  store.subscribe(['pose'], ({pose}) => {
    if (mapped === null || mapped.pose === pose) return;
    mapped = null;
    measurer.drop('occlusion');
  });
  store.subscribe(['pose', 'policy', 'stiffness', 'trees', 'unit'], () => counted(tick()));
  store.subscribe(['pose', 'policy', 'trees', 'dragging', 'wantsMap'], later);
  store.subscribe(['preset', 'reach', 'unit', 'frame'], () => {
    store.set({bite: null});
    later();
  });
  return {settled: () => waiting === undefined && asking === 0};
}

/** @param {Readonly<State>} state */
export function biteQuestion({pose, preset, reach, unit, frame}) {
  return {pose, preset, reach, unit: unit ?? undefined, frame};
}

/**
 * @param {Readonly<State>} state
 * @returns {boolean} whether both bodies hold the triangles that a map is measured on
 */
export function measurable({bodies}) {
  return Boolean(bodies.fixed?.rebuilds && bodies.moving?.rebuilds);
}

/**
 * @param {Readonly<State>} state
 * @returns {string | null} of both bodies; null: assumed to be millimetres
 */
export function unitOf({bodies, unit}) {
  return bodies.fixed?.unit ?? bodies.moving?.unit ?? unit;
}

/**
 * @param {Readonly<State>} state
 * @param {{pose: Pose, policy: Policy | null} | null} at  where something was asked
 * @returns {boolean} whether that is the pose and the policy that are shown
 */
export function isHere({pose, policy}, at) {
  return at !== null && at.pose === pose && at.policy === policy;
}

/** @param {unknown} error */
function isCancelled(error) {
  return error instanceof EngineError && error.code === 'cancelled';
}

/** @param {Readonly<State>} state */
function perUnit(state) {
  return millimetresIn(unitOf(state)) ** 3;
}
