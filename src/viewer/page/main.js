/** Wires the page: state, engine, picture, panels; then opens what the page came with. */

import {openAbout} from './about.js';
import {makeBodiesLoader} from './bodies_loader.js';
import {readDataBlock} from './data_block.js';
import {faultText, makeEngineClient} from './engine/engine_client.js';
import {startEngine, unpackEngine} from './engine/engine_start.js';
import {builtIn} from './facing.js';
import {followPose} from './follow.js';
import {makeAddress} from './state/address.js';
import {readFragment, writeFragment} from './state/fragment.js';
import {listenToKeys} from './keyboard.js';
import {openDropped, openFirst} from './open_first.js';
import {makeAccuracyPanel} from './panels/accuracy.js';
import {makeBodiesPanel} from './panels/bodies.js';
import {makeContactsPanel} from './panels/contacts.js';
import {makeOcclusionPanel} from './panels/occlusion.js';
import {makePosePanel} from './panels/pose.js';
import {makeRecordingPanel} from './panels/recording.js';
import {makeSavePanel} from './panels/save.js';
import {makeTreePanel} from './panels/tree.js';
import {identity, translation} from './pose.js';
import {makePoseHistory} from './state/pose_history.js';
import {makeReadout} from './readout.js';
import {makeReadRecording} from './recording/read_recording.js';
import {makeStore} from './state/store.js';
import {exposeTestSurface} from './test_surface.js';
import {takeDrops} from './ui/file_drop.js';
import {makeMessages} from './ui/messages.js';
import {makeProgress} from './ui/progress.js';
import {makeTabs} from './ui/tabs.js';
import {makeAnyStage} from './view/any_stage.js';

/**
 * Dark or light: as the system says, until the button says otherwise.
 * @param {import('./context.js').Store} store
 * @param {import('./view/stage.js').Stage} stage
 * @param {HTMLElement} button
 */
function followTheme(store, stage, button) {
  const system = matchMedia('(prefers-color-scheme: dark)');
  const shown = () => store.get().theme ?? (system.matches ? 'dark' : 'light');
  const apply = () => {
    const theme = shown();
    document.documentElement.dataset.theme = theme;
    button.textContent = theme === 'dark' ? 'Light' : 'Dark';
    stage.setBackground(getComputedStyle(document.documentElement).getPropertyValue('--view').trim());
  };
  button.addEventListener('click', () => store.set({theme: shown() === 'dark' ? 'light' : 'dark'}));
  system.addEventListener('change', apply);
  store.subscribe(['theme'], apply);
  apply();
}

// Just apart, so that a little closing shows what there is to see.
const startShift = [0, 0, -1.5];

/** @param {unknown} error  after which the page cannot go on */
function lostWords(error) {
  const text = faultText(error) ?? 'The engine ended';
  return `${text.replace(/\.$/, '')}. Load the page again; if that does not help, use a browser from 2023 or later.`;
}

/** @param {string} id */
function byId(id) {
  const found = document.getElementById(id);
  if (!found) throw new Error(`the page has no element ${id}`);
  return found;
}

/** @returns {import('./context.js').State} */
function firstState() {
  return {
    bodies: {fixed: null, moving: null},
    jaws: null,
    trees: null,
    pose: translation(startShift),
    home: [...identity],
    facing: builtIn,
    dragging: false,
    voxelSize: null,
    policy: null,
    stiffness: 0.1,
    tick: null,
    answer: null,
    cancelled: null,
    bite: null,
    preset: 'scan',
    reach: 2,
    unit: null,
    fileUnit: null,
    frame: '',
    wantsMap: false,
    book: false,
    theme: null,
    panel: 'pose',
    seed: 1,
  };
}

/** The page is painted before its picture and its engine take the processor. One that is not seen waits for nothing. */
function painted() {
  return new Promise((resolve) => {
    new PerformanceObserver(resolve).observe({type: 'paint', buffered: true});
    setTimeout(resolve, document.hidden ? 0 : 2000);
  });
}

async function main() {
  const {dataset} = document.documentElement;
  dataset.state = 'busy';
  await painted();
  const say = makeMessages(byId('messages'));
  const store = makeStore(firstState());
  const stage = makeAnyStage(byId('surface'), say);
  followTheme(store, stage, byId('theme'));
  const texts = await unpackEngine();

  const makeBar = (/** @type {() => void} */ onCancel) => makeProgress(byId('progress'), onCancel);
  const engine = makeEngineClient({
    start: () => startEngine(texts),
    progress: makeBar(() => engine.cancel()),
    restore: (ask) => loader.restore(ask),
    onLost: (error) => {
      dataset.state = 'failed';
      say(lostWords(error), 'error');
    },
  });
  const measurer = makeEngineClient({
    start: () => startEngine(texts),
    lazy: true,
    progress: makeBar(() => measurer.cancel()),
    restore: (ask) => loader.restore(ask, false),
    onLost: (error) => {
      const text = faultText(error);
      measurer.drop(undefined, 'cancelled');
      if (text) say(`${text.replace(/\.$/, '')}: what was asked of the second engine is not done.`, 'error');
    },
  });
  const loader = makeBodiesLoader({store, say, ask: engine.ask});
  const history = makePoseHistory(store);
  const context = {engine, measurer, store, stage, loader, history, say, readRecording: makeReadRecording(makeBar)};
  const recording = makeRecordingPanel(context);
  const panels = [
    makeBodiesPanel(context),
    makePosePanel(context),
    makeAccuracyPanel(context),
    makeTreePanel(context),
    makeContactsPanel(context),
    makeOcclusionPanel(context),
    recording,
    makeSavePanel(context),
  ];
  const show = makeTabs(byId('tabs'), byId('panels'), panels, (panel) => store.set({panel}));
  const {settled} = followPose(context);
  makeReadout(byId('readout'), store);
  listenToKeys(context);
  byId('about').addEventListener('click', () => openAbout(engine));

  store.subscribe(['bodies'], ({bodies}) => {
    stage.setBody('fixed', bodies.fixed);
    stage.setBody('moving', bodies.moving);
    byId('subject').textContent =
      bodies.fixed && bodies.moving ? `${bodies.fixed.name} and ${bodies.moving.name}` : 'where two bodies touch';
  });
  store.subscribe(['bodies'], () => measurer.drop());
  store.subscribe(['pose'], ({pose}) => stage.setPose(pose));
  store.subscribe(['facing'], ({facing}) => stage.setUpright(facing.up, facing.front));
  store.subscribe(['panel'], ({panel}) => show(panel));
  const setAddress = makeAddress((fragment) => window.history.replaceState(null, '', fragment));
  store.subscribe(['panel', 'pose', 'dragging', 'voxelSize', 'policy', 'preset', 'theme', 'seed'], (state) => {
    if (!state.dragging) setAddress(writeFragment(state));
  });
  takeDrops(document.body, async (files) => {
    const recorded = files.find((file) => /\.(jsonl|json|csv)$/i.test(file.name));
    store.set({panel: recorded ? 'recording' : 'bodies'});
    if (recorded) await recording.openFile(recorded);
    const meshes = files.filter((file) => file !== recorded);
    if (meshes.length > 0) await openDropped(context, meshes);
  });
  let opened = false;
  exposeTestSurface({
    store,
    engine,
    busy: () => engine.busy() || measurer.busy(),
    settled,
    opened: () => opened,
    playback: recording.progress,
    picture: stage.picture,
  });

  const panelIds = panels.map((panel) => panel.id);
  const {change, problems} = readFragment(location.hash, panelIds);
  const {data, problem} = readDataBlock(byId('ist-data').textContent ?? 'null');
  for (const each of [...problems, ...(problem ? [problem] : []), ...(data?.missing ?? [])]) say(each, 'warning');
  store.set(change);
  show(store.get().panel);
  stage.setPose(store.get().pose);
  await openFirst(context, data, change, recording.open);
  opened = true;
  // An address that somebody pastes over this one; the page's own changes of it make no such event.
  window.addEventListener('hashchange', async () => {
    const pasted = readFragment(location.hash, panelIds),
      {seed, voxelSize, ...others} = pasted.change;
    for (const each of pasted.problems) say(each, 'warning');
    store.set(others);
    const {jaws} = store.get();
    const remade = jaws !== null && seed !== undefined && seed !== jaws;
    if (remade && !(await loader.makeJaws(seed))) return;
    if (remade || (voxelSize && voxelSize !== store.get().voxelSize)) await loader.build(voxelSize ?? undefined);
  });
}

main().catch((error) => {
  document.documentElement.dataset.state = 'failed';
  makeMessages(byId('messages'))(lostWords(error), 'error');
});
