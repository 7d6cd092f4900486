/**
 * The data that a command wrote into the page. The page holds one element
 *
 *     <script type="application/json" id="ist-data">null</script>
 *
 * and the command replaces the word between its tags by a JSON object, a DataBlock, and no other
 * byte. In that JSON every `<` is written as `\u003c`, so that no name ends the element.
 *
 * Lengths are in mesh units unless a member says otherwise. A matrix is 16 numbers, column by
 * column, and rigid.
 *
 * @typedef {object} DataBlock
 * @property {1} format
 * @property {string} made_by   program and version: "ist 1.2.3"
 * @property {'bite' | 'recording' | 'bodies'} kind
 *   `bite`: two bodies, `pose` and `occlusion`. `recording`: `recording`, and all bodies of the scene
 *   in the order of their numbers with `metres_per_unit`, or no bodies, which `missing` then explains. `bodies`: one body or two, perhaps a `pose`.
 * @property {BlockBody[]} bodies
 * @property {number[]} [pose]        moving to fixed coordinates; the identity where it is missing
 * @property {BlockOcclusion} [occlusion]
 * @property {number} [metres_per_unit]  metres in the unit of the bodies
 * @property {string} [recording]     the text of the recording as `ist run --record` wrote it: JSON lines
 * @property {string[]} [missing]     sentences on what is not here, shown to people: "jaw.stl is not
 *   where the recording says: put it beside run.jsonl and write the page again"
 *
 * @typedef {object} BlockBody
 * @property {'fixed' | 'moving'} role
 *   the first body of each role is the one that the engine is asked about, all others are only
 *   drawn. In a recording: `moving` if the hand holds it at the start
 * @property {string} name            of its file without its folder, or its name in the scene
 * @property {string} tree            base64 (with `+`, `/` and `=`) of a tree file that keeps its triangles;
 *   its voxels may be coarse, for the page builds its own
 * @property {number} [index]         in a recording: its place among the header's `bodies`
 * @property {boolean} [held]         in a recording: whether the hand holds it at the start
 * @property {number[]} [pose]        in a recording: the body's place in the scene before the first
 *   tick. It maps mesh coordinates times `metres_per_unit` to the scene's, in metres
 * @property {number[]} [in_tool]     of a held body: maps mesh coordinates times `metres_per_unit` to
 *   the tool's frame, in metres. With the tool's pose T of a tick, T · in_tool is the body's place
 *
 * @typedef {object} BlockOcclusion
 * @property {string} preset
 * @property {number} reach           millimetres
 * @property {'mm' | 'm' | 'inch' | 'µm'} [unit]   as given by `--unit`
 * @property {string} [frame]         "lps", "ras" or ""
 */

import {isRigid} from './pose.js';

const newestFormat = 1;
const kinds = ['bite', 'recording', 'bodies'];

/**
 * Reads the text of the block.
 * @param {string} text
 * @returns {{data: DataBlock | null, problem: string | null}} no data: the page shows the built-in
 *   jaws, after the sentence where there is a problem
 */
export function readDataBlock(text) {
  /** @type {any} */
  let data;
  try {
    data = JSON.parse(text);
  } catch {
    return refused('The data in this page is cut off or damaged: get the file again, or write it again with ist view.');
  }
  if (data === null) return {data: null, problem: null};
  if (typeof data !== 'object' || typeof data.format !== 'number') {
    return refused('The data in this page is of no known format: write the page again with ist view.');
  }
  if (data.format > newestFormat) {
    return refused(
      `The data in this page is of format ${data.format} and was made by a newer version (${data.made_by}); ` +
        `this page reads format ${newestFormat}: write the page again with the version of IST that it is to be opened with.`,
    );
  }
  const fault = faultOf(data);
  return fault ? refused(`The data in this page is damaged (${fault}): write the page again with ist view.`) : {data, problem: null};
}

/**
 * @param {string} text
 * @returns {Uint8Array<ArrayBuffer>}
 */
export function fromBase64(text) {
  const characters = atob(text);
  const bytes = new Uint8Array(characters.length);
  for (let i = 0; i < characters.length; i++) bytes[i] = characters.charCodeAt(i);
  return bytes;
}

/** @param {string} problem */
function refused(problem) {
  return {data: null, problem: `${problem} The built-in jaws are shown instead.`};
}

/**
 * @param {any} data
 * @returns {string} what is wrong, or nothing
 */
function faultOf(data) {
  if (!kinds.includes(data.kind)) return `its kind is ${JSON.stringify(data.kind)}, not one of ${kinds.join(', ')}`;
  if (!Array.isArray(data.bodies) || (data.kind !== 'recording' && data.bodies.length === 0)) return 'it lists no bodies';
  const {missing} = data;
  if (missing !== undefined && !(Array.isArray(missing) && missing.every((each) => typeof each === 'string')))
    return 'what is missing is not said in sentences';
  for (const [index, body] of data.bodies.entries()) {
    if (body?.role !== 'fixed' && body?.role !== 'moving') return `body ${index} has no role`;
    if (typeof body.name !== 'string' || typeof body.tree !== 'string') return `body ${index} has no name or tree`;
    if (body.tree.length % 4 !== 0 || !/^[A-Za-z0-9+/]*={0,2}$/.test(body.tree)) return `the tree of body ${index} is cut off`;
    if (data.kind === 'recording' && !isRigid(body.pose)) return `body ${index} has no rigid pose`;
    if (body.in_tool !== undefined && !isRigid(body.in_tool)) return `in_tool of body ${index} is not rigid`;
  }
  if (data.pose !== undefined && !isRigid(data.pose)) return 'its pose is not rigid';
  if (data.kind === 'bite') {
    for (const role of ['fixed', 'moving']) {
      if (!data.bodies.some((/** @type {BlockBody} */ body) => body.role === role)) return `there is no ${role} body`;
    }
    if (typeof data.occlusion?.preset !== 'string' || !(data.occlusion.reach > 0)) return 'it names no preset or reach';
  }
  if (data.kind === 'recording') {
    if (typeof data.recording !== 'string') return 'there is no recording';
    if (data.bodies.length > 0 && !(data.metres_per_unit > 0)) return 'its unit is missing';
  }
  return '';
}
