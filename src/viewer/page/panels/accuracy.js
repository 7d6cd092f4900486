/** What accuracy costs in time: the voxel size, the policy, and a plot of the points already visited. */

import ratio from '../native_ratio.json';
import {policies as all} from '../choices.js';
import {isHere, unitOf} from '../follow.js';
import {button, select, slider} from '../ui/controls.js';
import {element} from '../ui/element.js';
import {plot} from '../ui/plot.js';
import {facts, table} from '../ui/table.js';
import {makeNearestLine} from '../view/nearest_line.js';
import {count, depthWords, interval, nearestWords, short, unitWord} from '../words.js';

/** @typedef {import('../context.js').State} State */
/** @typedef {import('../context.js').Answer} Answer */
/** @typedef {import('../protocol.js').Policy} Policy */
/** @typedef {{voxelSize: number, policy: Policy, microseconds: number, resolution: number}} Visited */

/** @type {Record<Policy, {colour: string, words: string}>} */
const policies = {
  simple: {colour: 'var(--series-4)', words: 'simple: balls round the cubes'},
  table: {colour: 'var(--series-3)', words: 'table: balls by occupancy'},
  tight: {colour: 'var(--series-2)', words: 'tight: balls round the triangles'},
  slab: {colour: 'var(--series-1)', words: 'slab: those balls, cut by slabs'},
};
const tourWords = 'Visit seven voxel sizes';
const tour = [2, 1.4, 1, 0.7, 0.5, 0.4, 0.3];

/** @type {import('../context.js').MakePanel} */
export function makeAccuracyPanel({store, stage, loader}) {
  const nearest = makeNearestLine(stage, store);
  /** @type {Visited[]} */
  let visited = [];
  const scale = () => scaleFor(store.get().bodies.moving?.extent ?? 110);
  const voxel = slider({
    label: 'Voxel size',
    min: 0.2,
    max: 2,
    logarithmic: true,
    value: 0.4,
    words: (value) => `${short(value, 3)} ${unitWord(unitOf(store.get()))}`,
    onInput: () => {},
    onChange: async (value) => {
      await loader.build(Number(value.toPrecision(3)));
      fill(); // a build that was refused or cancelled left the trees of before
    },
  });
  const policy = select({
    label: 'Policy',
    value: 'slab',
    choices: policyChoices(all),
    onChange: (value) => store.set({policy: /** @type {Policy} */ (value)}),
  });
  const numbers = element('div', {'aria-live': 'polite'}),
    points = element('div');
  const curve = plot({
    label: 'Error, the resolution, over the time of a query, of the voxel sizes and policies visited at this pose',
    xLabel: 'time of a query, µs',
    yLabel: 'resolution',
    logX: true,
    logY: true,
  });
  /** @type {(() => void) | null} ends the visits that are made now */
  let stop = null;
  const tourButton = button(tourWords, async () => {
    if (stop) return stop();
    const stopped = new Promise((resolve) => {
      stop = () => resolve('stopped');
    });
    tourButton.textContent = 'Stop the visits';
    for (const size of tour) {
      if (!(await loader.build(size * scale()))) break;
      if ((await Promise.race([stopped, nextAnswer()])) === 'stopped') break;
    }
    stop = null;
    tourButton.textContent = tourWords;
  });
  const nextAnswer = () =>
    new Promise((resolve) => {
      const end = store.subscribe(['answer', 'cancelled'], ({answer, cancelled}) => {
        if (!answer && !cancelled) return;
        end();
        resolve(answer ? 'answered' : 'stopped');
      });
    });

  const panel = element(
    'div',
    {},
    element('h2', {}, 'Accuracy against time'),
    element(
      'p',
      {},
      'Smaller voxels tell touching from near more sharply, and take longer. Two surfaces in a leaf pair are no farther apart than the resolution.',
    ),
    voxel.element,
    policy.element,
    numbers,
    curve.element,
    points,
    element(
      'div',
      {class: 'row'},
      tourButton,
      button('Forget the points', () => {
        visited = [];
        draw();
      }),
    ),
    element('p', {class: 'quiet'}, ratioWords()),
  );

  const draw = () => {
    const {answer} = store.get();
    const series = all.flatMap((name) => {
      const points = visited.filter((each) => each.policy === name);
      if (points.length === 0) return [];
      const current = points.findIndex((each) => answer?.line.spheres === name && each.voxelSize === answer.line.voxel_size[0]);
      return [
        {
          name,
          colour: policies[name].colour,
          current,
          points: points.map((each) => /** @type {[number, number]} */ ([each.microseconds, each.resolution])),
          words: points.map(
            (each) =>
              `${name}, voxels of ${short(each.voxelSize, 3)}: ${short(each.microseconds, 3)} µs, resolution ${short(each.resolution, 3)}`,
          ),
        },
      ];
    });
    curve.set(series);
    points.replaceChildren(...(visited.length > 0 ? [visitedTable(visited, unitWord(unitOf(store.get())))] : []));
  };
  /** @type {Answer['pose'] | null} */
  let visitedAt = null;
  store.subscribe(['answer'], ({answer}) => {
    if (answer) {
      // Time hangs on the pose, so that a curve is of one.
      if (visitedAt !== answer.pose) visited = [];
      visitedAt = answer.pose;
      const {line, microseconds} = answer;
      const point = {voxelSize: line.voxel_size[0], policy: line.spheres, microseconds, resolution: line.resolution};
      visited = [...visited.filter((each) => each.voxelSize !== point.voxelSize || each.policy !== point.policy), point];
      draw();
    }
    numbers.replaceChildren(answerFacts(answer, unitWord(unitOf(store.get()))));
  });
  store.subscribe(['answer', 'pose', 'policy'], (state) => numbers.classList.toggle('stale', !isHere(state, state.answer)));
  store.subscribe(['bodies'], () => {
    visited = [];
    draw();
    voxel.range(0.2 * scale(), 2 * scale());
  });
  store.subscribe(['trees', 'policy'], fill);
  function fill() {
    const {trees, policy: chosen} = store.get();
    if (!trees) return;
    voxel.set(trees.moving.voxel_size);
    policy.offer(policyChoices(trees.policies));
    policy.set(chosen ?? trees.policies[trees.policies.length - 1]);
  }
  return {
    id: 'accuracy',
    title: 'Accuracy',
    element: panel,
    shown() {
      fill();
      nearest.show(true);
    },
    hidden: () => nearest.show(false),
  };
}

/** @param {Policy[]} offered */
function policyChoices(offered) {
  return offered.map((value) => ({value: /** @type {string} */ (value), words: policies[value].words}));
}

/**
 * @param {number} extent
 * @returns {number} by which sizes of a jaw, which is some 110 mm wide, are multiplied
 */
function scaleFor(extent) {
  return 10 ** Math.round(Math.log10(extent / 110));
}

/**
 * @param {Answer | null} answer
 * @param {string} unit
 */
function answerFacts(answer, unit) {
  if (!answer) return element('p', {}, 'The numbers come when the trees are built and the pose rests.');
  const {line, microseconds} = answer;
  return facts([
    ['Time of a query', `${short(microseconds, 3)} µs, the median of groups of 20 and more`],
    ['Sphere tests', count(line.sphere_tests)],
    ['Leaf pairs', count(line.leaf_pairs)],
    ['Resolution', `${short(line.resolution)} ${unit}`],
    ['Touch', line.touch],
    ['Distance', interval(line.distance_lower, line.distance_upper, unit)],
    ['Nearest points (yellow)', nearestWords(line)],
    ['Depth', depthWords(line, unit)],
  ]);
}

/**
 * The points of the plot in words.
 * @param {Visited[]} visited
 * @param {string} unit
 */
function visitedTable(visited, unit) {
  const rows = [...visited].sort((a, b) => b.voxelSize - a.voxelSize || a.microseconds - b.microseconds);
  return table(
    'Visited at this pose',
    ['policy', `voxels, ${unit}`, 'time, µs', `resolution, ${unit}`],
    rows.map(({policy, voxelSize, microseconds, resolution}) => [
      policy,
      short(voxelSize, 3),
      short(microseconds, 3),
      short(resolution, 3),
    ]),
  );
}

function ratioWords() {
  if (ratio.ratio === null) return 'How much slower this page is than the program itself is not measured yet.';
  return (
    `In a page the engine takes ${short(ratio.ratio, 2)} times as long as the program itself, ` +
    `which took ${short(/** @type {any} */ (ratio.native_microseconds), 3)} µs (${ratio.machine}, commit ${ratio.commit}).`
  );
}
