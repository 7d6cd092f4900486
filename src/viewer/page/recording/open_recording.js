/** Opens a recording: its ticks, and its bodies as far as they are known. */

import {fromBase64} from '../data_block.js';
import {placedByScene, sceneBodies} from './scene_bodies.js';
import {relative, spansOf} from './placed_bodies.js';

/** @typedef {import('../context.js').Context} Context */
/** @typedef {import('../data_block.js').DataBlock} DataBlock */
/** @typedef {import('../data_block.js').BlockBody} BlockBody */
/** @typedef {import('../protocol.js').BodyFacts} BodyFacts */
/** @typedef {import('../protocol.js').Pose} Pose */
/** @typedef {import('./placed_bodies.js').Span} Span */
/** @typedef {import('./recording.js').Recording} Recording */

/**
 * @typedef {object} Opened
 * @property {Recording} recording
 * @property {Scene | null} scene   null: the bodies are not known, and only frames are drawn
 */
/**
 * @typedef {object} Scene
 * @property {number} metresPerUnit
 * @property {Span[][]} spans        of each body
 * @property {number} fixed          index of the body that the engine has as fixed
 * @property {number} moving
 * @property {{index: number, facts: BodyFacts}[]} others  bodies that are only drawn
 */

/**
 * @param {string | Blob} content
 * @param {string} name
 * @param {Pick<Context, 'loader' | 'store' | 'say' | 'readRecording'>} context
 * @returns {Promise<Opened>}
 */
export async function openRecordingFile(content, name, {loader, store, say, readRecording}) {
  const recording = await readRecording(content, name);
  if (recording.cutOff) say(recording.cutOff, 'warning');
  const {header} = recording;
  const scene = sceneBodies(header);
  const missing = (/** @type {string} */ why) => {
    say(
      `The recording comes without its bodies (${why}): their frames alone are drawn. Write a page with its bodies: ist view run.jsonl --scene SCENE.toml -o run.html.`,
      'warning',
    );
    return {recording, scene: null};
  };
  if (!scene) return missing('its scene is of more than two bodies, or of trees');
  const jaws = scene.fixed.shape === 'upper jaw' && scene.held.shape === 'lower jaw' && scene.fixed.seed === scene.held.seed;
  if (jaws) {
    if (store.get().jaws !== scene.fixed.seed && !(await loader.makeJaws(scene.fixed.seed))) return missing('the jaws could not be made');
    if (!store.get().trees) await loader.build();
  }
  const {fixed, moving} = store.get().bodies;
  if (!fixed || !moving) return missing('no bodies are open');
  if (!jaws) {
    for (const [facts, body] of /** @type {[BodyFacts, any][]} */ ([
      [fixed, header.bodies[0]],
      [moving, header.bodies[1]],
    ])) {
      if (!body.hash || facts.info.source?.hash !== body.hash) return missing(`${body.file ?? body.name} is not open here`);
    }
  }
  const placed = placedByScene(scene, {fixed, moving}, header);
  return {recording, scene: {metresPerUnit: header.unit, spans: spansOf(placed, recording), fixed: 0, moving: 1, others: []}};
}

/**
 * @param {DataBlock} data  of kind recording
 * @param {Pick<Context, 'loader' | 'store' | 'say' | 'readRecording'>} context
 * @returns {Promise<Opened>}
 */
export async function openRecordingData(data, context) {
  const {loader, store, say, readRecording} = context;
  const text = data.recording ?? '',
    name = 'the recording';
  if (data.bodies.length === 0) return openRecordingFile(text, name, context);
  const recording = await readRecording(text, name);
  if (recording.cutOff) say(recording.cutOff, 'warning');
  const fixed = data.bodies.findIndex((body) => body.role === 'fixed');
  const moving = data.bodies.findIndex((body) => body.role === 'moving');
  if (fixed < 0 || moving < 0) return {recording, scene: null};
  const metresPerUnit = /** @type {number} */ (data.metres_per_unit);
  const placed = data.bodies.map((body) => ({
    name: recording.header.bodies[body.index ?? 0]?.name ?? body.name,
    held: Boolean(body.held),
    pose: /** @type {Pose} */ (body.pose),
    in_tool: body.in_tool,
  }));
  const spans = spansOf(placed, recording);
  /** @type {Scene['others']} */
  const others = [];
  // Each in turn takes the place of its role; the two that are asked about come last, and stay.
  for (const [index, body] of data.bodies.entries()) {
    if (index === fixed || index === moving) continue;
    if (!(await loader.open(fileOf(body)))) continue;
    const facts = store.get().bodies[body.role];
    if (facts) others.push({index, facts});
  }
  const pose = relative(placed[fixed].pose, placed[moving].pose, metresPerUnit);
  if (!(await loader.replace([fileOf(data.bodies[fixed]), fileOf(data.bodies[moving])], pose))) return {recording, scene: null};
  return {recording, scene: {metresPerUnit, spans, fixed, moving, others}};
}

/** @param {BlockBody} body */
export function fileOf({role, name, tree}) {
  return {role, name, content: new Blob([fromBase64(tree)])};
}
