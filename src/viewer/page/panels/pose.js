/** The pose of the moving body: handles, six numbers, a matrix, undo, and the first contact. */

import {middleOf} from '../body_box.js';
import {faultText} from '../engine/engine_client.js';
import {directionWords} from '../facing.js';
import {unitOf} from '../follow.js';
import {along, fromSixNumbers, matrixText, moved, parseMatrix, toSixNumbers} from '../pose.js';
import {button, numberField, select} from '../ui/controls.js';
import {element, newId} from '../ui/element.js';
import {short, unitWord} from '../words.js';
import {makeGizmo} from '../view/gizmo.js';
import {makePointMark} from '../view/point_mark.js';
import {closingSpan} from '../readout.js';

/** @typedef {import('../context.js').State} State */

const axes = ['x', 'y', 'z'];
const tolerance = 1e-5;

/** @type {import('../context.js').MakePanel} */
export function makePosePanel({store, stage, engine, history, say}) {
  const gizmo = makeGizmo(stage, store),
    mark = makePointMark(stage, store);
  const centre = () => middleOf(store.get().bodies.moving);
  const six = () => toSixNumbers(store.get().pose, centre());
  /**
   * @param {'shift' | 'turn'} kind
   * @param {number} axis
   * @param {number} value
   */
  const setNumber = (kind, axis, value) => {
    const numbers = six();
    numbers[kind][axis] = value;
    store.set({pose: fromSixNumbers(numbers, centre()), dragging: false});
  };

  const fields = {
    shift: axes.map((name, axis) => numberField({label: `Shift ${name}`, value: 0, onChange: (value) => setNumber('shift', axis, value)})),
    turn: axes.map((name, axis) => numberField({label: `Turn ${name}, °`, value: 0, onChange: (value) => setNumber('turn', axis, value)})),
  };
  const undo = button('Undo', history.undo, {title: 'Control and Z'}),
    redo = button('Redo', history.redo, {title: 'Control, Shift and Z'});

  const firstContact = async () => {
    const {pose, home, bodies, facing} = store.get();
    const way = directionWords(facing.closing),
      unit = unitWord(unitOf(store.get()));
    const far = closingSpan(bodies.moving?.extent ?? 110) * 2;
    // Apart here, the body closes on to where the slider ends.
    const further = Math.max(0, along(pose, home, centre(), facing.closing));
    const at = (/** @type {number} */ distance) =>
      moved(
        pose,
        facing.closing.map((part) => part * distance),
      );
    try {
      const found = await engine.ask(
        'first_contact',
        {from: at(-far), to: at(further), tolerance},
        {doing: `Looking for the first contact along ${way}`},
      );
      if (found.status !== 'contact' || !found.point) {
        say(firstContactWords(found.status, way), 'warning');
        return;
      }
      store.set({pose: found.pose, dragging: false});
      mark.show(found.point, 'first contact');
      stage.flyTo(found.point);
      const place = found.point.map((value) => short(value, 5)).join(', ');
      say(`First contact at (${place}) ${unit}, within ${short(tolerance * (far + further), 2)} ${unit} of this pose.`);
    } catch (error) {
      const text = faultText(error);
      if (text) say(text, 'error');
    }
  };

  const matrixId = newId('matrix');
  const matrix = element('textarea', {id: matrixId, rows: 4, spellcheck: 'false', autocomplete: 'off'});
  const takeMatrix = () => {
    try {
      store.set({pose: parseMatrix(matrix.value), dragging: false});
    } catch (error) {
      say(faultText(error) ?? '', 'error');
    }
  };
  const copyMatrix = async () => {
    matrix.value = matrixText(store.get().pose);
    try {
      await navigator.clipboard.writeText(matrix.value);
      say('The matrix is copied, row by row: ist --matrix reads it.');
    } catch {
      matrix.select();
      say('This browser does not let the page copy: the matrix is selected, press Control and C.', 'warning');
    }
  };

  const panel = element(
    'div',
    {},
    element('h2', {}, 'Pose of the moving body'),
    element(
      'div',
      {class: 'row'},
      button('First contact', firstContact, {primary: true, title: 'Closes the body from far away to where it touches first'}),
      undo,
      redo,
      button('As it came', () => store.set({pose: store.get().home, dragging: false})),
    ),
    select({
      label: 'Handles in the picture',
      value: 'translate',
      choices: [
        {value: 'translate', words: 'shift'},
        {value: 'rotate', words: 'turn'},
      ],
      onChange: (mode) => gizmo.setMode(/** @type {'translate' | 'rotate'} */ (mode)),
    }).element,
    element(
      'fieldset',
      {},
      element('legend', {}, 'Six numbers: turned about x, y, then z through its middle, then shifted'),
      element('div', {class: 'grid three'}, ...fields.shift.map((each) => each.element), ...fields.turn.map((each) => each.element)),
    ),
    element(
      'div',
      {class: 'control'},
      element('label', {for: matrixId}, 'Matrix: four rows of four, or 16 numbers column by column in one line'),
      matrix,
    ),
    element('div', {class: 'row'}, button('Copy the matrix', copyMatrix), button('Take this matrix', takeMatrix)),
    element(
      'p',
      {class: 'quiet'},
      'In the picture: arrow keys turn the view, + and − come nearer and go farther; with Shift, arrow keys and Page Up and Down move the body.',
    ),
  );

  const fill = (/** @type {Readonly<State>} */ {dragging}) => {
    const numbers = six();
    for (const [kind, list] of /** @type {['shift' | 'turn', typeof fields.shift][]} */ (Object.entries(fields))) {
      for (const [axis, field] of list.entries()) field.set(Number(numbers[kind][axis].toFixed(6)));
    }
    undo.disabled = !history.canUndo();
    redo.disabled = !history.canRedo();
    if (!dragging && document.activeElement !== matrix) matrix.value = matrixText(store.get().pose);
  };
  store.subscribe(['pose', 'home', 'bodies', 'dragging'], fill);
  fill(store.get());
  return {id: 'pose', title: 'Pose', element: panel, shown: () => gizmo.show(true), hidden: () => gizmo.show(false)};
}

/**
 * @param {string} status
 * @param {string} way  along which the body closes
 */
function firstContactWords(status, way) {
  switch (status) {
    case 'none':
      return `Nothing touches on the way along ${way} to this pose: turn or shift the body so that they meet.`;
    case 'grazing':
      return 'On the way the bodies come as near as rounding can tell, without meeting for certain: shift the body a little.';
    case 'touches-at-start':
      return `They touch even far away along ${way}: their sizes may differ, or this is not the way they close.`;
    default:
      return `There is no first contact along ${way}: ${status.replaceAll('-', ' ')}.`;
  }
}
