/** The two bodies: the built-in jaws, or files, and what is known of them. */

import {unitChoices} from '../choices.js';
import {button, numberField, select} from '../ui/controls.js';
import {element} from '../ui/element.js';
import {fileField} from '../ui/file_drop.js';
import {bytesWords, count, differInFrame, infoSentences, short, unitWord} from '../words.js';
import {facts} from '../ui/table.js';
import {directionWords} from '../facing.js';
import {unitOf} from '../follow.js';

/** @typedef {import('../context.js').State} State */
/** @typedef {import('../protocol.js').Role} Role */
/** @typedef {import('../protocol.js').TreeFacts} TreeFacts */

const endings = '.stl,.ply,.obj,.off,.vtk,.vtp,.glb,.gltf,.3mf,.ist';
/** @type {Role[]} */
const roles = ['fixed', 'moving'];
const titles = {fixed: 'Fixed body', moving: 'Moving body'};

/** @type {import('../context.js').MakePanel} */
export function makeBodiesPanel({store, loader, stage, history}) {
  let seed = store.get().seed;
  /**
   * @param {Role} role
   * @param {File} file
   */
  const open = async (role, file) => {
    const opened = await loader.open({role, name: file.name, content: file, unit: store.get().fileUnit ?? undefined});
    if (opened) await settle();
  };
  const settle = async () => {
    const pose = store.get().home;
    store.set({pose, dragging: false});
    history.forget();
    await loader.build();
    stage.frameAll();
  };
  const number = numberField({
    label: 'Built-in jaws, number',
    value: seed,
    min: 0,
    max: 999_999_999,
    step: 1,
    onChange: (value) => {
      seed = value;
    },
  });
  const parts = {fixed: element('section'), moving: element('section')},
    facingLine = element('p');
  const swap = button(
    'Swap',
    async () => {
      if (!(await loader.swap())) return;
      history.forget();
      await loader.build();
      stage.frameAll();
    },
    {title: 'The fixed body moves, and the moving one is fixed'},
  );
  const turn = button(
    'Turn the moving body into the frame of the fixed one',
    async () => {
      if (await loader.turn()) await settle();
    },
    {title: 'x and y of its mesh change their signs'},
  );
  const panel = element(
    'div',
    {},
    element('h2', {}, 'Bodies'),
    element('p', {}, 'Nothing that you open leaves this page: the engine is in it.'),
    element(
      'div',
      {class: 'row'},
      number.element,
      button('Make these jaws', async () => {
        if (await loader.makeJaws(seed)) await settle();
      }),
    ),
    select({
      label: 'Unit of the files you open',
      value: '',
      choices: unitChoices('as the file says, else millimetres'),
      onChange: (value) => store.set({fileUnit: value === '' ? null : value}),
    }).element,
    facingLine,
    element('div', {class: 'row'}, swap, turn),
    ...roles.map((role) =>
      element(
        'section',
        {class: `body ${role}`},
        element('h3', {}, titles[role]),
        parts[role],
        fileField(`Open another (${endings.replaceAll(',', ' ')})`, endings, (file) => open(role, file)),
      ),
    ),
  );

  const fill = (/** @type {Readonly<State>} */ state) => {
    for (const role of roles) parts[role].replaceChildren(...bodyLines(state, role));
    facingLine.textContent = facingWords(state);
    // The built-in jaws are known.
    turn.hidden = !state.bodies.fixed || !state.bodies.moving || !differInFrame(state.bodies.fixed, state.bodies.moving);
    swap.hidden = state.jaws !== null || !state.bodies.fixed || !state.bodies.moving;
  };
  store.subscribe(['bodies', 'facing', 'jaws', 'trees', 'unit'], fill);
  store.subscribe(['seed'], (state) => {
    ({seed} = state);
    number.set(seed);
  });
  fill(store.get());
  return {id: 'bodies', title: 'Bodies', element: panel, shown: () => {}, hidden: () => {}};
}

/** @param {Readonly<State>} state */
function facingWords({bodies, facing, jaws}) {
  if (!bodies.fixed || !bodies.moving) return 'One body is missing: drop the file of the other jaw.';
  const closes = `the moving body closes along ${directionWords(facing.closing)}`;
  if (jaws !== null) return `The fixed body is the upper jaw, and ${closes}.`;
  if (!facing.known) return `The bodies are too far from each other to tell which is the upper one. It is assumed that ${closes}.`;
  return `By the normals of the surfaces that face each other, the ${facing.upper} body is the upper one, and ${closes}.`;
}

/**
 * @param {Readonly<State>} state
 * @param {Role} role
 */
function bodyLines(state, role) {
  const body = state.bodies[role];
  if (!body) return [element('p', {}, 'There is none yet.')];
  const lines = [
    element('p', {}, element('strong', {}, body.name)),
    ...infoSentences({unit: body.unit, ...body.info}, unitOf(state) ?? undefined).map((sentence) => element('p', {}, sentence)),
    ...body.warnings.map((warning) => element('p', {class: 'warned'}, `${warning.replace(/\.$/, '')}.`)),
  ];
  return state.trees ? [...lines, treeFacts(state.trees[role], unitWord(unitOf(state)))] : lines;
}

/**
 * @param {TreeFacts} tree
 * @param {string} unit
 */
function treeFacts(tree, unit) {
  return facts([
    ['Voxel size', `${short(tree.voxel_size)} ${unit}`],
    ['Leaves', count(tree.leaves)],
    ['Levels', String(tree.depth + 1)],
    ['Tree', bytesWords(tree.bytes)],
    ['Built in', tree.milliseconds > 0 ? `${short(tree.milliseconds / 1000, 2)} s` : 'read from the file'],
  ]);
}
