/** Opens what the page came with: the data of a command, or else the built-in jaws. */

import {openRecordingData, fileOf} from './recording/open_recording.js';
import {faultText} from './engine/engine_client.js';
import {identity} from './pose.js';

/** @typedef {import('./context.js').Context} Context */
/** @typedef {import('./context.js').State} State */
/** @typedef {import('./data_block.js').DataBlock} DataBlock */
/** @typedef {import('./recording/open_recording.js').Opened} Opened */

/**
 * @param {Context} context
 * @param {DataBlock | null} data
 * @param {Partial<State>} asked  by the address, which comes before the data
 * @param {(opened: Opened) => void} onRecording
 */
export async function openFirst(context, data, asked, onRecording) {
  const {store, loader, stage, history, say} = context;
  let opened = false;
  try {
    opened = data !== null && (await openData(context, data, asked, onRecording));
  } catch (error) {
    const text = faultText(error);
    if (text) say(`${text} The built-in jaws are shown instead.`, 'error');
  }
  if (!opened) {
    if (!(await loader.makeJaws(store.get().seed))) return;
    stage.frameAll();
    await buildFirst(loader, asked);
  }
  history.forget();
}

/**
 * @param {Context} context
 * @param {DataBlock} data
 * @param {Partial<State>} asked
 * @param {(opened: Opened) => void} onRecording
 * @returns {Promise<boolean>} whether the data could be opened
 */
async function openData(context, data, asked, onRecording) {
  const {store, loader, stage} = context;
  if (data.kind === 'recording') {
    onRecording(await openRecordingData(data, context));
    store.set({panel: asked.panel ?? 'recording'});
    return true;
  }
  if (data.kind === 'bite' && data.occlusion) {
    const {preset, reach, unit, frame} = data.occlusion;
    store.set({preset: asked.preset ?? preset, reach, frame: frame ?? '', panel: asked.panel ?? 'occlusion'});
    for (const body of data.bodies) {
      if (!(await loader.open({...fileOf(body), unit}))) return false;
    }
  } else {
    for (const body of data.bodies) {
      if (!(await loader.open(fileOf(body)))) return false;
    }
    store.set({panel: asked.panel ?? 'bodies'});
  }
  const pose = data.pose ?? [...identity];
  store.set({pose: asked.pose ?? pose, home: pose, dragging: false});
  stage.frameAll();
  await buildFirst(loader, asked);
  return true;
}

/**
 * Builds the trees as the address says; where that voxel size is refused, as the page would by itself.
 * @param {Context['loader']} loader
 * @param {Partial<State>} asked
 */
async function buildFirst(loader, {voxelSize}) {
  const wanted = voxelSize ?? undefined;
  if (!(await loader.build(wanted)) && wanted !== undefined) await loader.build();
}

/**
 * Opens the meshes that were dropped together. One alone takes the empty place; where there is none, it waits for the other jaw.
 * @param {Context} context
 * @param {File[]} files
 */
export async function openDropped({store, loader, stage, history, say}, files) {
  const {bodies, fileUnit} = store.get();
  const empty = bodies.fixed ? (bodies.moving ? null : 'moving') : 'fixed';
  for (const [at, content] of files.entries()) {
    const role = files.length === 1 ? (empty ?? 'fixed') : at === 0 ? 'fixed' : 'moving';
    const begins = at === 0 && (files.length > 1 || empty === null);
    if (!(await loader.open({role, name: content.name, content, unit: fileUnit ?? undefined}, begins))) return;
  }
  store.set({pose: store.get().home, dragging: false});
  if (files.length === 1 && empty === null) say(`${files[0].name} is open. Now the other jaw: drop its file too.`);
  await loader.guessRoles();
  history.forget();
  await loader.build();
  stage.frameAll();
}
