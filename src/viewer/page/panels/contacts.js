/** Contacts: points, normals and depths, and the force and torque that a hand would feel. */

import {unitOf} from '../follow.js';
import {checkbox, slider} from '../ui/controls.js';
import {element} from '../ui/element.js';
import {facts, table} from '../ui/table.js';
import {count, short, unitWord} from '../words.js';
import {wrenchAtMiddle} from '../wrench.js';
import {makeContactMarks} from '../view/contact_marks.js';

/** @typedef {import('../protocol.js').Contacts} Contacts */

const listed = 10;
const seeThrough = 0.35;

/** @type {import('../context.js').MakePanel} */
export function makeContactsPanel({store, stage}) {
  const marks = makeContactMarks(stage);
  let through = true,
    seen = false;
  const stiffness = slider({
    label: 'Stiffness',
    min: 0.001,
    max: 10,
    logarithmic: true,
    value: store.get().stiffness,
    words: (value) => `${short(value, 2)} N/mm³`,
    onInput: (value) => store.set({stiffness: value}),
  });
  const sums = element('div'),
    list = element('div');
  const panel = element(
    'div',
    {},
    element('h2', {}, 'Contacts'),
    element(
      'p',
      {},
      'Where a hand that holds the moving body feels the other: leaf pairs, gathered to points. Each has a spring that pushes along the normal. Springs see voxels, so no spring is pressed by more than a voxel. The depth of the bodies stands below the picture.',
    ),
    sums,
    stiffness.element,
    element(
      'p',
      {class: 'quiet'},
      'Force and torque are those of springs of this stiffness between the surfaces. They are for a hand; they are no bite force.',
    ),
    checkbox('See through the bodies', through, (on) => {
      through = on;
      fade();
    }).element,
    list,
  );
  const fade = () => {
    for (const role of /** @type {('fixed' | 'moving')[]} */ (['fixed', 'moving'])) stage.fade(role, seen && through ? seeThrough : 1);
  };

  const fill = () => {
    if (!seen) return;
    const state = store.get();
    const {tick, bodies} = state;
    const unit = unitWord(unitOf(state));
    marks.set(tick?.contacts ?? null, bodies.moving?.extent ?? 1);
    sums.replaceChildren(sumFacts(tick?.contacts ?? null, unit));
    list.replaceChildren(
      ...(tick
        ? [
            contactTable(tick.contacts, unit, (at) => {
              marks.choose(at);
              stage.flyTo([...tick.contacts.positions.subarray(3 * at, 3 * at + 3)]);
            }),
          ]
        : []),
    );
  };
  store.subscribe(['tick', 'bodies', 'unit'], fill);
  store.subscribe(['book'], ({book}) => marks.show(seen && !book));
  return {
    id: 'contacts',
    title: 'Contacts',
    element: panel,
    shown() {
      seen = true;
      marks.show(!store.get().book);
      fade();
      fill();
    },
    hidden() {
      seen = false;
      marks.show(false);
      fade();
    },
  };
}

/**
 * @param {Contacts | null} contacts
 * @param {string} unit
 */
function sumFacts(contacts, unit) {
  if (!contacts) return element('p', {}, 'There are none before the trees are built.');
  const {at, force, torque} = wrenchAtMiddle(contacts);
  const size = (/** @type {number[]} */ v) => Math.hypot(...v);
  const along = (/** @type {number[]} */ v) => v.map((value) => short(value, 3)).join(', ');
  return facts([
    ['Contacts', count(contacts.depths.length)],
    ['Force on the moving body (green)', `${short(size(force), 3)} N (${along(force)})`],
    ['Torque (pink)', `${short(size(torque), 3)} N ${unit} (${along(torque)})`],
    ["About the contacts' middle", contacts.depths.length ? along(at) : '–'],
  ]);
}

/**
 * @param {Contacts} contacts
 * @param {string} unit
 * @param {(at: number) => void} onPick
 */
function contactTable({positions, normals, depths, weights}, unit, onPick) {
  const order = [...depths.keys()].sort((a, b) => depths[b] - depths[a]).slice(0, listed);
  if (order.length === 0) return element('p', {}, 'Nothing is near enough to be felt: close the bodies.');
  const three = (/** @type {Float64Array} */ of, /** @type {number} */ at, /** @type {number} */ digits) =>
    [...of.subarray(3 * at, 3 * at + 3)].map((value) => value.toFixed(digits).replace('-', '−')).join(' ');
  return table(
    `The ${order.length === 1 ? 'only contact' : `most pressed ${order.length} of ${count(depths.length)} contacts`}, fixed coordinates`,
    ['#', `spring pressed, ${unit}`, `position, ${unit}`, 'normal', `weight, ${unit}²`],
    order.map((at, rank) => [
      element(
        'button',
        {type: 'button', class: 'small', 'aria-label': `Look at contact ${rank + 1}`, onclick: () => onPick(at)},
        String(rank + 1),
      ),
      short(depths[at], 3),
      three(positions, at, 1),
      three(normals, at, 2),
      short(weights[at], 3),
    ]),
  );
}
