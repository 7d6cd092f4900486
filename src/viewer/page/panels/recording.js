/** A recording of `ist run`: it plays, with force, contacts and distance over time. */

import {faultText} from '../engine/engine_client.js';
import {placeAt, relative} from '../recording/placed_bodies.js';
import {openRecordingFile} from '../recording/open_recording.js';
import {indexAt, makePlayback, toolPath} from '../recording/playback.js';
import {arrowsOf} from '../recording/points.js';
import {identity} from '../pose.js';
import {button, select, slider} from '../ui/controls.js';
import {element} from '../ui/element.js';
import {fileField} from '../ui/file_drop.js';
import {plot} from '../ui/plot.js';
import {facts, table} from '../ui/table.js';
import {count, short, unitWord} from '../words.js';
import {unitOf} from '../follow.js';
import {makePlayerView} from '../view/player_view.js';

/** @typedef {import('../context.js').Context} Context */
/** @typedef {import('../context.js').Panel} Panel */
/** @typedef {import('../recording/open_recording.js').Opened} Opened */
/** @typedef {import('../recording/playback.js').Playback} Playback */
/** @typedef {import('../protocol.js').Pose} Pose */

const distancesAsked = 150;
const speeds = ['0.05', '0.1', '0.25', '0.5', '1', '2'];
// Frames without bodies are drawn in millimetres.
const frameScale = 1e3;
// A spring of some hundred N/m draws the tool by fractions of a millimetre, which nobody sees.
const handApart = 10;

/**
 * @param {Context} context
 * @returns {Panel & {open: (opened: Opened) => void, openFile: (file: File) => Promise<void>, progress: () => {tick: number, last: number} | null}}
 */
export function makeRecordingPanel(context) {
  const {store, stage, engine, say} = context;
  const view = makePlayerView(stage);
  /** @type {Opened | null} */
  let opened = null;
  /** @type {import('../context.js').State['bodies'] | null} those that its scene is of */
  let bodiesThen = null;
  /** @type {Playback | null} */
  let playback = null;
  let seen = false;

  const play = button('Play', () => playback?.toggle(), {primary: true});
  const scrub = slider({
    label: 'Tick',
    min: 0,
    max: 1,
    step: 1,
    value: 0,
    words: tickWords,
    onInput: (at) => {
      playback?.pause();
      playback?.jump(at);
    },
  });
  const speed = select({
    label: 'Speed',
    value: '1',
    choices: speeds.map((value) => ({value, words: `${value} ×`})),
    onChange: (value) => playback?.setSpeed(Number(value)),
  });
  const pick = (/** @type {number} */ time) => opened && playback?.jump(indexAt(opened.recording.ticks, time));
  const time = {xLabel: 'time, s', lines: true, onPick: pick};
  const plots = {
    force: plot({...time, label: 'Force on the hand over time', yLabel: 'force, N'}),
    points: plot({...time, label: 'Contact points over time', yLabel: 'contact points'}),
    contacts: plot({...time, label: 'Leaf pairs over time', yLabel: 'leaf pairs'}),
    distance: plot({...time, label: 'Distance over time', yLabel: 'distance'}),
  };
  let apart = handApart;
  const apartSlider = slider({
    label: 'Hand drawn away from the tool',
    min: 1,
    max: 50,
    step: 1,
    value: apart,
    words: (value) => (value === 1 ? 'as it is' : `${value} times as far`),
    onInput: (value) => {
      apart = value;
      playback?.jump(playback.at());
    },
  });
  // A scene has contact or springs. Springs have leaf pairs in place of contact points.
  const ofPoints = element('div', {}, element('h3', {}, 'Contact points'), plots.points.element),
    ofPairs = element('div', {}, element('h3', {}, 'Leaf pairs'), plots.contacts.element);
  const now = element('div'),
    head = element('p');
  const player = element(
    'div',
    {hidden: true},
    head,
    element(
      'div',
      {class: 'row'},
      play,
      button('Back a tick', () => step(-1)),
      button('On a tick', () => step(1)),
    ),
    scrub.element,
    speed.element,
    apartSlider.element,
    now,
    element('h3', {}, 'Force on the hand'),
    plots.force.element,
    ofPoints,
    ofPairs,
    element('h3', {}, 'Distance, asked here'),
    plots.distance.element,
    element(
      'p',
      {class: 'quiet'},
      'Short strokes on the time axis are late ticks. The body in its own colour is the tool, the faint pink one is where the hand draws it to. Arrows are the forces on the tool at contact points: the longest and reddest is the largest of the recording.',
    ),
  );
  const panel = element(
    'div',
    {},
    element('h2', {}, 'Recording'),
    element('p', {}, 'Plays what ist run SCENE --record run.jsonl wrote: how a hand moved one body against the other, and what it felt.'),
    fileField('Open a recording (.jsonl)', '.jsonl,.json,.csv,.txt', (file) => openFile(file)),
    player,
  );

  /** @param {number} at */
  function tickWords(at) {
    const tick = opened?.recording.ticks[at];
    return tick ? `${count(tick.tick)}, ${tick.time.toFixed(3)} s` : '–';
  }
  /** @param {number} by */
  const step = (by) => {
    playback?.pause();
    playback?.jump(playback.at() + by);
  };

  /** @param {File} file */
  async function openFile(file) {
    try {
      open(await openRecordingFile(file, file.name, context));
    } catch (error) {
      const text = faultText(error);
      if (text) say(`${file.name}: ${text}`, 'error');
    }
  }

  /** @param {Opened} next */
  function open(next) {
    playback?.pause();
    opened = next;
    const {
      recording: {ticks},
      scene,
    } = next;
    bodiesThen = store.get().bodies;
    player.hidden = false;
    head.textContent = headWords(next.recording);
    scrub.range(0, ticks.length - 1);
    playback = makePlayback(ticks, show);
    const late = {
      name: 'late ticks',
      colour: 'var(--series-2)',
      ticks: true,
      points: ticks.filter((tick) => tick.late).map((tick) => /** @type {[number, number]} */ ([tick.time, 0])),
    };
    plots.force.set([{name: 'force', colour: 'var(--series-1)', points: ticks.map((tick) => [tick.time, tick.force])}, late]);
    ofPoints.hidden = !next.recording.byPoints;
    ofPairs.hidden = next.recording.byPoints;
    plots.points.set([
      {name: 'contact points', colour: 'var(--series-3)', points: ticks.map((tick) => [tick.time, tick.points.length])},
      late,
    ]);
    plots.contacts.set([
      {name: 'leaf pairs', colour: 'var(--series-3)', points: ticks.map((tick) => [tick.time, tick.contacts ?? NaN])},
      late,
    ]);
    plots.distance.set([]);
    arrange();
    if (scene)
      askDistances().catch((error) => {
        const text = faultText(error);
        if (text) say(text, 'error');
      });
  }

  function arrange() {
    if (!opened || !seen) {
      playback?.jump(playback.at());
      view.clear();
      for (const role of roles) stage.fade(role, 1);
      return;
    }
    const {
      scene,
      recording: {ticks},
    } = opened;
    for (const role of roles) stage.fade(role, scene ? 1 : 0);
    if (scene) {
      const {moving} = store.get().bodies;
      view.set(
        moving,
        scene.others.map((other) => other.facts),
        moving?.extent ?? 1,
      );
      playback?.jump(playback.at());
      stage.frameAll();
      return;
    }
    const {points, middle, size} = toolPath(ticks, frameScale);
    view.set(null, [], 8 * size);
    view.setPath(points);
    playback?.jump(playback.at());
    stage.flyTo(middle, [0.4, 1, 0.3], 5 * size);
  }

  /** @param {number} at */
  const poseAt = (at) => {
    if (!opened?.scene) return null;
    const {
      scene,
      recording: {ticks},
    } = opened;
    const {tool, device} = ticks[at];
    const fixed = placeAt(scene.spans[scene.fixed], at, tool);
    const place = (/** @type {number} */ body, /** @type {Pose} */ frame) =>
      relative(fixed, placeAt(scene.spans[body], at, frame), scene.metresPerUnit);
    return {
      tool: place(scene.moving, tool),
      hand: device && awayFrom(place(scene.moving, tool), place(scene.moving, device), apart),
      fixed,
      others: scene.others.map(({index}) => place(index, tool)),
    };
  };

  /**
   * @param {number} at
   * @param {boolean} playing
   */
  function show(at, playing) {
    if (!opened) return;
    const tick = opened.recording.ticks[at];
    play.textContent = playing ? 'Pause' : 'Play';
    scrub.set(at);
    for (const each of Object.values(plots)) each.mark(tick.time);
    const {recording, scene} = opened;
    const poses = poseAt(at);
    const arrows = arrowsOf(
      tick.points,
      poses?.fixed ?? [...identity],
      poses && scene ? scene.metresPerUnit : 1 / frameScale,
      recording.strongest,
    );
    now.replaceChildren(tickFacts(tick, handAway(tick), recording.byPoints), ...pointTable(tick, arrows));
    if (!seen) return;
    view.placePoints(arrows);
    if (poses) {
      view.placeBodies(poses.hand, poses.others);
      store.set({pose: poses.tool, dragging: playing});
    } else {
      view.placeFrames(scaled(tick.tool), tick.device && scaled(tick.device));
    }
  }

  /**
   * @param {import('../recording/recording.js').Tick} tick
   * @param {import('../recording/points.js').Arrow[]} arrows  of its points, as drawn
   */
  function pointTable({points}, arrows) {
    if (!opened || points.length === 0) return [];
    const {scene, recording} = opened;
    const unit = scene ? unitWord(unitOf(store.get())) : 'mm';
    const named = (/** @type {number} */ body) => recording.header.bodies[body]?.name ?? `body ${body}`;
    const size = (/** @type {number} */ at) => Math.hypot(...points[at].force);
    const order = [...points.keys()].sort((a, b) => size(b) - size(a));
    return [
      table(
        `${points.length === 1 ? 'The contact point' : `${points.length} contact points`}, ${scene ? 'fixed' : 'scene'} coordinates`,
        ['#', 'force, N', `position, ${unit}`, 'bodies', 'triangles', 'gap, µm'],
        order.map((at, rank) => [
          element(
            'button',
            {
              type: 'button',
              class: 'small',
              'aria-label': `Look at contact point ${rank + 1}`,
              onclick: () => stage.flyTo(arrows[at].at),
            },
            String(rank + 1),
          ),
          short(size(at), 3),
          arrows[at].at.map((value) => value.toFixed(2).replace('-', '−')).join(' '),
          points[at].bodies.map(named).join(', '),
          points[at].triangles.map(String).join(', '),
          short(1e6 * points[at].gap, 3),
        ]),
      ),
    ];
  }

  /** @param {import('../recording/recording.js').Tick} tick */
  const handAway = ({tool, device: hand}) => hand && Math.hypot(...[12, 13, 14].map((at) => hand[at] - tool[at]));

  async function askDistances() {
    const mine = opened;
    if (!mine) return;
    const {ticks} = mine.recording;
    const unit = unitWord(unitOf(store.get()));
    const every = Math.max(1, Math.floor(ticks.length / distancesAsked));
    /** @type {[number, number][]} */
    const lower = [];
    for (let at = 0; at < ticks.length; at += every) {
      const poses = poseAt(at);
      if (!poses || opened !== mine) return;
      const {distance_lower: distance} = await engine.ask('tick', {pose: poses.tool, stiffness: 0});
      lower.push([ticks[at].time, distance]);
      if (lower.length % 25 === 0 || at + every >= ticks.length)
        plots.distance.set([{name: `distance, ${unit}`, colour: 'var(--series-4)', points: [...lower]}]);
    }
    if (playback) plots.distance.mark(ticks[playback.at()].time);
  }

  store.subscribe(['bodies'], ({bodies}) => {
    if (!opened?.scene || bodies === bodiesThen) return;
    playback?.pause();
    opened = {...opened, scene: null};
    head.textContent = `${headWords(opened.recording)} Its bodies gave way to others: its frames alone are drawn. Open it again to have them back.`;
    arrange();
  });

  return {
    id: 'recording',
    title: 'Recording',
    element: panel,
    open,
    openFile,
    progress: () =>
      opened &&
      playback && {tick: opened.recording.ticks[playback.at()].tick, last: opened.recording.ticks[opened.recording.ticks.length - 1].tick},
    shown() {
      seen = true;
      arrange();
    },
    hidden() {
      playback?.pause();
      seen = false;
      arrange();
    },
  };
}

const roles = /** @type {const} */ (['fixed', 'moving']);

/** @param {import('../recording/recording.js').Recording} recording */
function headWords({ticks, header, dt}) {
  /** @type {import('../protocol.js').Line[]} */
  const bodies = header.bodies;
  const scripted = bodies.filter(({script}) => script).map(({name}) => name);
  return (
    `${count(ticks.length)} ticks of ${short(dt * 1e6)} µs by ist ${header.ist}: ${bodies.map((body) => body.file ?? body.name).join(', ')}.` +
    (scripted.length > 0
      ? ` The page does not play the script of ${scripted.join(', ')}: it is drawn, and its distance asked, where it began.`
      : '')
  );
}

/** @param {Pose} pose */
function scaled(pose) {
  return [...identity].map((_, at) => (at >= 12 && at < 15 ? pose[at] * frameScale : pose[at]));
}

/**
 * @param {Pose} tool
 * @param {Pose} hand
 * @param {number} times
 * @returns {Pose} the hand's, shifted away from the tool
 */
function awayFrom(tool, hand, times) {
  return hand.map((value, at) => (at >= 12 && at < 15 ? tool[at] + times * (value - tool[at]) : value));
}

/**
 * @param {import('../recording/recording.js').Tick} tick
 * @param {number | null} away  metres from the tool to the hand
 * @param {boolean} byPoints
 */
function tickFacts(tick, away, byPoints) {
  const notes = [
    tick.late && 'late',
    tick.held && 'the tool was held',
    tick.halved && 'a step was shortened',
    tick.fault && 'the device gave no pose',
  ].filter(Boolean);
  return facts([
    ['Force', `${short(tick.force, 3)} N`],
    ['Torque', `${short(1000 * tick.torque, 3)} N mm`],
    ['Hand to tool', away === null ? 'not known' : `${short(1000 * away, 3)} mm`],
    byPoints ? ['Contact points', count(tick.points.length)] : ['Leaf pairs', tick.contacts === null ? 'not known' : count(tick.contacts)],
    ['Took', `${short(tick.microseconds, 3)} µs${notes.length ? ` (${notes.join(', ')})` : ''}`],
  ]);
}
