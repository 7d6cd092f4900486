/** The trees: the nodes of one level by policy, side by side, and one query, front by front. */

import {policies as all} from '../choices.js';
import {faultText} from '../engine/engine_client.js';
import {checkbox, select, slider} from '../ui/controls.js';
import {element} from '../ui/element.js';
import {table} from '../ui/table.js';
import {count} from '../words.js';
import {mostDrawn} from '../view/balls.js';
import {makeTreeView} from '../view/tree_view.js';

/** @typedef {import('../protocol.js').Policy} Policy */
/** @typedef {import('../protocol.js').Step} Step */
/** @typedef {import('../view/tree_view.js').Column} Column */

const long = {doing: 'Reading the trees', seldomLong: true};

/** @type {import('../context.js').MakePanel} */
export function makeTreePanel({store, engine, stage, say}) {
  const view = makeTreeView(stage);
  let seen = false,
    level = 4,
    stepping = false,
    step = 0,
    asked = 0;
  /** @type {Policy[]} */
  let chosen = ['slab'];
  /** @type {Step[]} */
  let steps = [];
  const levels = slider({
    label: 'Level, 0 are the leaves',
    min: 0,
    max: 9,
    step: 1,
    value: level,
    words: (value) => `level ${value}`,
    onInput: (value) => {
      level = value;
      later();
    },
  });
  const boxes = all.map((policy) =>
    checkbox(policy, chosen.includes(policy), (on) => {
      chosen = all.filter((each) => (each === policy ? on : chosen.includes(each)));
      later();
    }),
  );
  const mode = select({
    label: 'Show',
    value: 'level',
    choices: [
      {value: 'level', words: 'all nodes of a level'},
      {value: 'query', words: 'one query, front by front'},
    ],
    onChange: (value) => {
      stepping = value === 'query';
      arrange();
      later();
    },
  });
  const stepSlider = slider({
    label: 'Step of the query',
    min: 0,
    max: 1,
    step: 1,
    value: 0,
    words: stepWords,
    onInput: (value) => {
      step = value;
      later();
    },
  });
  const note = element('p', {'aria-live': 'polite'}),
    numbers = element('div');
  const policyBoxes = element(
    'fieldset',
    {},
    element('legend', {}, 'Policies, side by side'),
    element('div', {class: 'row'}, ...boxes.map((box) => box.element)),
  );
  const panel = element(
    'div',
    {},
    element('h2', {}, 'The tree'),
    element(
      'p',
      {},
      'A query goes down both trees, level by level, and keeps the pairs of nodes that overlap. Nodes that overlap another are orange.',
    ),
    mode.element,
    policyBoxes,
    levels.element,
    stepSlider.element,
    note,
    numbers,
  );
  const arrange = () => {
    levels.element.hidden = stepping;
    stepSlider.element.hidden = !stepping;
  };
  arrange();
  /** @param {number} at */
  function stepWords(at) {
    const shown = steps[at];
    return shown ? `${at + 1} of ${steps.length}: fixed level ${shown.fixed_level}, moving level ${shown.moving_level}` : 'none';
  }

  let waiting = 0;
  const later = () => {
    clearTimeout(waiting);
    if (seen) waiting = setTimeout(() => draw().catch(failed), 60);
  };
  /** @param {unknown} error */
  const failed = (error) => {
    const text = faultText(error);
    if (text) say(text, 'error');
    else note.textContent = 'That was cancelled, and the nodes of before are drawn: choose a level or a step, and it is asked again.';
  };

  async function draw() {
    const {trees, pose, dragging} = store.get();
    if (!trees || dragging) return;
    asked += 1;
    const mine = asked;
    const policies = chosen.filter((policy) => trees.policies.includes(policy));
    /** @type {Column[]} */
    const columns = [];
    const rows = [];
    for (const policy of policies) {
      const found = stepping ? await front(policy) : await whole(policy);
      if (mine !== asked || !seen) return;
      columns.push(found.column);
      rows.push(found.row);
    }
    view.draw(columns, pose, store.get().bodies);
    note.textContent =
      policies.length === 0
        ? 'Choose a policy that both trees have.'
        : columns.some((column) => column.only) && !stepping
          ? `A level of more than ${count(mostDrawn)} nodes shows those alone that overlap another.`
          : stepping && steps.length === 0
            ? 'The two roots do not overlap here: the query ends at once. Close the bodies.'
            : '';
    numbers.replaceChildren(
      policies.length === 0
        ? ''
        : stepping
          ? table('This step', ['policy', 'tests', 'pairs that overlap', 'nodes, fixed and moving'], rows)
          : table(`Level ${level}`, ['policy', 'nodes, fixed and moving', 'of them touched'], rows),
    );
  }

  /** @param {Policy} policy */
  async function whole(policy) {
    const {pose, trees} = store.get();
    const depth = (/** @type {'fixed' | 'moving'} */ role) => Math.min(level, trees?.[role].depth ?? 0);
    const fixed = await engine.ask('level', {role: 'fixed', policy, level: depth('fixed')}, long);
    const moving = await engine.ask('level', {role: 'moving', policy, level: depth('moving')}, long);
    const touched = await engine.ask('touched', {pose, policy, level}, long);
    const many = fixed.radii.length + moving.radii.length > mostDrawn;
    return {
      column: {policy, fixed, moving, touched, only: many ? touched : null},
      row: [
        policy,
        `${count(fixed.radii.length)} and ${count(moving.radii.length)}`,
        `${count(touched.fixed.length)} and ${count(touched.moving.length)}`,
      ],
    };
  }

  /** @param {Policy} policy */
  async function front(policy) {
    const {pose} = store.get();
    ({steps} = await engine.ask('fronts', {pose, policy}, long));
    step = Math.max(0, Math.min(step, steps.length - 1));
    stepSlider.range(0, Math.max(0, steps.length - 1));
    stepSlider.set(step);
    const at = steps[step];
    if (!at) return {column: emptyColumn(policy), row: [policy, '0', '0', '0 and 0']};
    const pairs = await engine.ask('front', {pose, policy, step}, long);
    const nodes = {fixed: sorted(pairs.fixed), moving: sorted(pairs.moving)};
    const fixed = await engine.ask('level', {role: 'fixed', policy, level: pairs.fixed_level}, long);
    const moving = await engine.ask('level', {role: 'moving', policy, level: pairs.moving_level}, long);
    return {
      column: {policy, fixed, moving, touched: null, only: nodes},
      row: [policy, count(at.tests), count(at.pairs), `${count(nodes.fixed.length)} and ${count(nodes.moving.length)}`],
    };
  }

  store.subscribe(['pose', 'dragging', 'trees'], ({trees}) => {
    if (trees) {
      levels.range(0, Math.max(trees.fixed.depth, trees.moving.depth));
      level = Math.min(level, trees.fixed.depth);
      levels.set(level);
    }
    later();
  });
  return {
    id: 'tree',
    title: 'Tree',
    element: panel,
    shown() {
      seen = true;
      later();
    },
    hidden() {
      seen = false;
      view.clear();
    },
  };
}

const nothing = {centres: new Float32Array(), radii: new Float32Array()};

/**
 * @param {Policy} policy
 * @returns {Column}
 */
function emptyColumn(policy) {
  return {policy, fixed: nothing, moving: nothing, touched: null, only: null};
}

/**
 * @param {Uint32Array} nodes
 * @returns {Uint32Array} each once, ascending
 */
function sorted(nodes) {
  return Uint32Array.from(new Set(nodes)).sort();
}
