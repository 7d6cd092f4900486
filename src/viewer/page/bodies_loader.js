/**
 * Gives the engine its two bodies and their trees, and keeps what it takes to give them again to
 * another engine: the built-in jaws' seed, the files, and the voxel size.
 */

import {faultText} from './engine/engine_client.js';
import {builtIn, directionWords, facingOf, swapped} from './facing.js';
import {identity, inverse} from './pose.js';
import {meshBytes} from './scene_files.js';
import {bytesWords, differInFrame, frameWord, short, unitNames} from './words.js';

/** @typedef {import('./context.js').Store} Store */
/** @typedef {import('./context.js').Context} Context */
/** @typedef {import('./protocol.js').Role} Role */
/** @typedef {import('./protocol.js').Pose} Pose */
/** @typedef {import('./protocol.js').Unit} Unit */
/** @typedef {import('./protocol.js').BodyFacts} BodyFacts */
/** @typedef {import('./engine/engine_client.js').EngineClient['ask']} Ask */

/** @typedef {import('./protocol.js').Frame} Frame */

/** @typedef {{role: Role, name: string, content: Blob, unit?: Unit, toFrame?: Frame}} BodyFile */
/**
 * @typedef {object} BodiesLoader  each promise gives whether it was done; if not, a sentence was said, or
 *   somebody cancelled or replaced it
 * @property {(seed: number) => Promise<boolean>} makeJaws
 * @property {(file: BodyFile, alone?: boolean) => Promise<boolean>} open  of one role; trees are not built by it; `alone`: the other place is empty then
 * @property {() => Promise<boolean>} turn  turns the moving body's mesh into the fixed body's frame; trees are not built by it
 * @property {() => Promise<boolean>} guessRoles  gives the upper body the fixed role, where it is known which is the upper one
 * @property {() => Promise<boolean>} swap  gives each body the other one's role, where they are; trees are not built by it
 * @property {(voxelSize?: number) => Promise<boolean>} build  none: one that is quick to ask
 * @property {(files: BodyFile[], pose?: Pose) => Promise<boolean>} replace  opens, poses and builds
 * @property {(ask: Ask, trees?: boolean) => Promise<void>} restore  gives another engine the bodies, and their trees where those are wanted
 */

// The engine has 4 GiB, which hold the file, its mesh and its tree.
const mostBytes = 1e9;
// Of the smaller body's extent: 0.4 mm of a jaw, which answers in time for every frame.
const firstVoxel = 1 / 275;
// Of the larger body's extent: a finer tree of it is too large for a page.
const finestVoxel = 1 / 2000;
// Faults of a build that another voxel size mends. Texts of the others have their remedy.
const sizeFaults = new Set(['memory-limit', 'voxel-size-invalid', 'voxel-size-too-small']);
// Bodies whose sizes differ by more are of different units: an inch has 25.4 mm.
const farApart = 20;

/**
 * @param {Pick<Context, 'store' | 'say'> & {ask: Ask}} context
 * @returns {BodiesLoader}
 */
export function makeBodiesLoader({store, say, ask}) {
  /** @type {{seed: number | null, files: Partial<Record<Role, BodyFile>>, voxelSize: number | null, built: boolean}} */
  const kept = {seed: null, files: {}, voxelSize: null, built: false};
  /** Results of the bodies before these are cleared. */
  const nothingKnown = {trees: null, tick: null, answer: null, cancelled: null, bite: null};
  let looked = false;
  /** @type {Partial<Record<Role, Pose>>} the home pose when a body was opened: of the bodies before it */
  let homes = {};

  /** @param {Promise<void>} done */
  const said = async (done) => {
    try {
      await done;
      return true;
    } catch (error) {
      const text = faultText(error);
      if (text) say(text, 'error');
      return false;
    }
  };

  /** @param {number} seed */
  async function makeJaws(seed) {
    const bodies = await ask('make_jaws', {seed}, {doing: 'Making the built-in jaws'});
    Object.assign(kept, {seed, files: {}, built: false});
    homes = {};
    looked = true;
    store.set({...nothingKnown, bodies, jaws: seed, seed, home: [...identity], facing: builtIn, unit: null});
  }

  /**
   * @param {BodyFile} file
   * @param {boolean} [alone]
   */
  async function open(file, alone = false) {
    if (file.content.size > mostBytes) {
      throw new Error(
        `${file.name}: it has ${bytesWords(file.content.size)}, and a page's memory takes files to ${bytesWords(mostBytes)}: ` +
          'make its mesh coarser, or ask the command, ist, which has no such limit.',
      );
    }
    const read = await ask('open', await question(file), {doing: `Reading ${file.name}`});
    // The engine keeps it under a name that is a file's.
    const facts = {...read, name: file.name};
    const other = file.role === 'fixed' ? 'moving' : 'fixed';
    kept.files = alone ? {[file.role]: file} : {...kept.files, [file.role]: file};
    kept.built = false;
    if (alone || kept.files[other]) kept.seed = null;
    const bodies = {...store.get().bodies, [file.role]: facts};
    if (alone) bodies[other] = null;
    // A pose that the bodies before came with says nothing of two others.
    const {home} = store.get(),
      both = alone || homes[other] === home;
    homes = both ? {} : {...homes, [file.role]: home};
    looked = false;
    store.set({...nothingKnown, bodies, jaws: null, home: both ? [...identity] : home, unit: file.unit ?? null});
    if (kept.seed !== null) say(`${facts.name} is measured against a built-in jaw, ${bodies[other]?.name}: open a file in its place too.`);
    for (const warning of facts.warnings) say(`${facts.name}: ${warning.replace(/\.$/, '')}.`, 'warning');
    if (!compare(bodies)) suspect(facts);
  }

  /**
   * @param {{fixed: BodyFacts | null, moving: BodyFacts | null}} bodies
   * @returns {boolean} whether a warning was said
   */
  function compare({fixed, moving}) {
    if (!fixed || !moving) return false;
    if (differInFrame(fixed, moving)) {
      say(
        `${fixed.name} says that it is in the frame ${frameWord(fixed)}, and ${moving.name} in ${frameWord(moving)}. ` +
          'Nothing is computed across frames: turn one into the other, in the panel Bodies.',
        'warning',
      );
      return true;
    }
    const [unit, other] = [unitOfBody('fixed', fixed), unitOfBody('moving', moving)];
    if (unit !== null && other !== null && unit !== other) {
      say(
        `${fixed.name} is in ${unitNames[unit]}, and ${moving.name} in ${unitNames[other]}. Both must be in one unit; nothing is converted: ` +
          'convert one of them, and open it again.',
        'warning',
      );
      return true;
    }
    const [small, large] = fixed.extent < moving.extent ? [fixed, moving] : [moving, fixed];
    if (large.extent > farApart * small.extent) {
      say(
        `${large.name} is ${short(large.extent / small.extent, 2)} times as large as ${small.name}: one of them may be in metres or inches. ` +
          'Both must be in one unit; nothing is converted.',
        'warning',
      );
      return true;
    }
    const known = unit ?? other ?? 'mm';
    // Whoever chose the unit for one file is about to open the other one again.
    if (known === 'mm' || known === store.get().unit || (unit !== null && other !== null)) return false;
    const [named, bare] = unit === null ? [moving, fixed] : [fixed, moving];
    say(
      `${named.name} is in ${unitNames[known]}, and no unit is known of ${bare.name}, so ${unitNames[known]} are assumed. If it is in another unit, ` +
        'choose that as the unit of the files you open, and open it again.',
      'warning',
    );
    return true;
  }

  /**
   * A built-in jaw names no unit, and is in millimetres.
   * @param {Role} role
   * @param {BodyFacts} body
   * @returns {Unit | null}
   */
  function unitOfBody(role, {unit}) {
    return unit ?? (kept.seed !== null && !kept.files[role] ? 'mm' : null);
  }

  /** @param {BodyFacts} body */
  function suspect({name, unit, extent}) {
    if (unit !== null || extent >= 1) return;
    say(
      `${name} is ${short(extent)} long, and no unit is known of it, so millimetres are assumed. If these are metres, ` +
        'choose metres as the unit of the files you open, and open it again.',
      'warning',
    );
  }

  /** Finds how both bodies face each other. Without an answer they do as the built-in jaws. */
  async function look() {
    const {home, frame} = store.get();
    const found = await ask('facing', {pose: home, frame}, {doing: 'Looking where the bodies face each other', seldomLong: true}).catch(
      () => ({
        known: false,
      }),
    );
    looked = true;
    store.set({facing: facingOf(found)});
  }

  async function swap() {
    const {bodies, pose, home, facing} = store.get();
    if (!bodies.fixed || !bodies.moving || kept.seed !== null) return;
    await ask('swap', {});
    const {fixed, moving} = kept.files;
    if (fixed && moving) kept.files = {fixed: {...moving, role: 'fixed'}, moving: {...fixed, role: 'moving'}};
    kept.built = false;
    homes = {};
    store.set({
      ...nothingKnown,
      bodies: {fixed: bodies.moving, moving: bodies.fixed},
      pose: inverse(pose),
      home: inverse(home),
      facing: swapped(facing, home),
    });
  }

  async function turn() {
    const {fixed} = store.get().bodies,
      file = kept.files.moving;
    if (fixed && file) await open({...file, toFrame: fixed.info.frame});
  }

  async function guessRoles() {
    const {fixed, moving} = store.get().bodies;
    if (!fixed || !moving) return;
    await look();
    const {facing} = store.get();
    if (!facing.known || facing.upper === 'fixed') return;
    await swap();
    say(
      `${fixed.name} lies below, so it is the moving body, which closes along ${directionWords(store.get().facing.closing)}. Swap, in the panel Bodies, changes that.`,
    );
  }

  /** @param {number} [wanted] */
  async function build(wanted) {
    const {fixed, moving} = store.get().bodies;
    if (!fixed || !moving) return;
    if (!looked) await look();
    const [small, large] = [fixed.extent, moving.extent].sort((a, b) => a - b);
    const voxelSize = wanted ?? Number(Math.max(firstVoxel * small, finestVoxel * large).toPrecision(2));
    try {
      const trees = await ask('build', {voxel_size: voxelSize}, {doing: 'Building both trees', latest: true});
      Object.assign(kept, {voxelSize, built: true});
      const {policy} = store.get();
      store.set({
        trees,
        voxelSize,
        policy: policy && trees.policies.includes(policy) ? policy : null,
        tick: null,
        answer: null,
        cancelled: null,
        bite: null,
      });
    } catch (error) {
      const text = faultText(error);
      // The trees of before still answer, and are what the panels show.
      if (text === null) throw error;
      const trees = store.get().trees === null ? 'There are no trees yet' : 'The trees of before are kept';
      const remedy = sizeFaults.has(/** @type {{code?: string}} */ (error).code ?? '') ? ': choose another voxel size' : '';
      throw new Error(`${text.replace(/\.$/, '')}. ${trees}${remedy}.`);
    }
  }

  /**
   * @param {BodyFile[]} files
   * @param {Pose} pose
   */
  async function replace(files, pose) {
    for (const file of files) await open(file);
    store.set({pose, home: pose, dragging: false});
    await build().catch((error) => {
      if (faultText(error) !== null) throw error; // who cancels the trees still sees the bodies
    });
  }

  return {
    makeJaws: (seed) => said(makeJaws(seed)),
    open: (file, alone) => said(open(file, alone)),
    guessRoles: () => said(guessRoles()),
    swap: () => said(swap()),
    turn: () => said(turn()),
    build: (voxelSize) => said(build(voxelSize)),
    replace: (files, pose = [...identity]) => said(replace(files, pose)),
    async restore(again, trees = true) {
      const {seed, files, voxelSize, built} = kept;
      if (seed !== null) await again('make_jaws', {seed});
      for (const file of Object.values(files)) {
        await again('open', await question(file));
      }
      if (built && trees) await again('build', {voxel_size: voxelSize});
    },
  };
}

/** @param {BodyFile} file */
async function question(file) {
  const {role, name, toFrame} = file;
  return {role, name, ...(await meshBytes(name, await bytesOf(file), file.unit)), ...(toFrame && {to_frame: toFrame})};
}

/**
 * @param {BodyFile} file
 * @returns {Promise<ArrayBuffer>}
 */
async function bytesOf({name, content}) {
  try {
    return await content.arrayBuffer();
  } catch (error) {
    throw new Error(
      `${name}: the browser cannot read it (${faultText(error)}). It may have changed since you chose it, or memory is short: choose it again.`,
    );
  }
}
