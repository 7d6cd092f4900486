/** Saves: the picture, the pose, the answers, both bodies as GLB, and their trees. */

import {faultText} from '../engine/engine_client.js';
import {biteQuestion, isHere, measurable} from '../follow.js';
import {matrixText} from '../pose.js';
import {button} from '../ui/controls.js';
import {element} from '../ui/element.js';
import {download} from '../ui/file_drop.js';

/** @typedef {import('../protocol.js').Role} Role */

/** @type {import('../context.js').MakePanel} */
export function makeSavePanel({store, stage, engine, measurer, say}) {
  /**
   * @param {string} label
   * @param {string} about
   * @param {() => Promise<void> | void} save
   */
  const line = (label, about, save) =>
    element(
      'div',
      {class: 'save-line'},
      button(label, async () => {
        try {
          await save();
        } catch (error) {
          const text = faultText(error);
          if (text) say(text, 'error');
        }
      }),
      element('span', {}, about),
    );

  const savePicture = async () => download('ist.png', await stage.picture());
  const savePose = () => download('pose.json', json([{pose: store.get().pose}]));
  const saveMatrix = () => download('pose.txt', new Blob([matrixText(store.get().pose)]));
  const saveAnswer = () => {
    const {answer, cancelled} = store.get();
    if (!answer || !isHere(store.get(), answer)) {
      throw new Error(
        isHere(store.get(), cancelled)
          ? 'The answer at this pose was cancelled: move the body a little, and it is asked again.'
          : 'The answer at this pose is not there yet: wait until the pose rests.',
      );
    }
    download('answer.jsonl', new Blob([`${JSON.stringify(answer.header)}\n${JSON.stringify(answer.line)}\n`]));
  };
  const saveBite = () => {
    const {bite, pose} = store.get();
    if (!bite || bite.pose !== pose) throw new Error('There is no map of this pose: open the panel Occlusion, and wait until it is made.');
    download('bite.json', json(bite.bite));
  };
  const saveGlb = async () => {
    if (!measurable(store.get()))
      throw new Error('GLB needs the triangles of both bodies, and one of these trees holds none: open its mesh instead.');
    const {bytes} = await measurer.ask('save_glb', biteQuestion(store.get()), {doing: 'Writing both bodies as GLB'});
    download('bite.glb', blob(bytes));
  };
  /** @param {Role} role */
  const saveTree = async (role) => {
    const {bytes} = await engine.ask('save_body', {role}, {doing: `Writing the tree of the ${role} body`});
    download(`${(store.get().bodies[role]?.name ?? role).replace(/\.[^.]*$/, '')}.ist`, blob(bytes));
  };
  const panel = element(
    'div',
    {},
    element('h2', {}, 'Save'),
    line('Picture', 'ist.png, as it is drawn', savePicture),
    line('Pose', 'pose.json, which ist collide --poses reads', savePose),
    line('Matrix', 'pose.txt, which --matrix reads', saveMatrix),
    line('Answer', 'answer.jsonl, the lines of ist collide --json', saveAnswer),
    line('Bite', 'bite.json, as ist occlusion writes it', saveBite),
    line('Both bodies', 'bite.glb, in the colours of the map, metres, y up', saveGlb),
    line('Fixed tree', '.ist, as ist build writes it', () => saveTree('fixed')),
    line('Moving tree', '.ist, as ist build writes it', () => saveTree('moving')),
    element(
      'p',
      {class: 'quiet'},
      'The address of this page holds the pose and the settings: copy it to come back to them. A mesh of a face or of jaws identifies a patient.',
    ),
  );
  return {id: 'save', title: 'Save', element: panel, shown: () => {}, hidden: () => {}};
}

/** @param {unknown} value */
function json(value) {
  return new Blob([`${JSON.stringify(value, null, 1)}\n`], {type: 'application/json'});
}

/** @param {Uint8Array} bytes */
function blob(bytes) {
  return new Blob([/** @type {BlobPart} */ (bytes)]);
}
