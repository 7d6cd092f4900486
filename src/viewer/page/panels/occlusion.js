/** The occlusion map: both bodies by their distance from each other, its legend, and its contacts. */

import {presets, unitChoices} from '../choices.js';
import {measurable, unitOf} from '../follow.js';
import {button, checkbox, select, slider} from '../ui/controls.js';
import {element} from '../ui/element.js';
import {unitWord} from '../words.js';
import {makeMapView} from '../view/map_view.js';
import {areaFacts, contactTable, legend} from './occlusion_words.js';

/** @type {import('../context.js').MakePanel} */
export function makeOcclusionPanel({store, stage}) {
  const view = makeMapView(stage, store);
  const preset = select({label: 'Preset', value: store.get().preset, choices: presets, onChange: (value) => store.set({preset: value})});
  const reach = slider({
    label: 'Reach of the search',
    min: 0.5,
    max: 5,
    step: 0.5,
    value: store.get().reach,
    words: (value) => `${value} mm`,
    onInput: () => {},
    onChange: (value) => store.set({reach: value}),
  });
  const unit = select({
    label: 'Unit of the meshes',
    value: '',
    choices: unitChoices('millimetres, assumed'),
    onChange: (value) => store.set({unit: value === '' ? null : value}),
  });
  const frame = select({
    label: 'Patient frame',
    value: store.get().frame,
    choices: [
      {value: '', words: 'not known: sides are +x and −x'},
      {value: 'lps', words: 'LPS: +x is left'},
      {value: 'ras', words: 'RAS: +x is right'},
    ],
    onChange: (value) => store.set({frame: value}),
  });
  // Closed, the bodies hide the surfaces that face each other.
  let opens = true,
    seen = false;
  const open = (/** @type {boolean} */ on) => {
    opens = on;
    book.set(on);
    store.set({book: on});
    view.home();
  };
  const book = checkbox('Open both bodies like a book', opens, open);
  const state = element('p', {class: 'map-state', 'aria-live': 'polite'});
  const again = button('Make the map', () => store.set({wantsMap: true}));
  const answer = element('div'),
    caveat = element('p', {class: 'caveat'});
  const panel = element(
    'div',
    {},
    element('h2', {}, 'Occlusion map'),
    element(
      'p',
      {},
      'Each vertex by its signed distance from the other body: negative inside. The presets are published limits, and none is a clinical recommendation.',
    ),
    preset.element,
    element(
      'div',
      {class: 'row'},
      book.element,
      button('Occlusal view', () => open(true), {title: 'Both arches from their teeth; the key Home, in the picture'}),
    ),
    state,
    again,
    answer,
    caveat,
    element('details', {}, element('summary', {}, 'Reach, unit and sides'), reach.element, unit.element, frame.element),
  );

  const fill = () => {
    const now = store.get();
    const {bite} = now;
    unit.element.hidden = Boolean(now.bodies.fixed?.unit ?? now.bodies.moving?.unit);
    preset.set(now.preset);
    reach.set(now.reach);
    unit.set(now.unit ?? '');
    frame.set(now.frame);
    const stale = bite !== null && bite.pose !== now.pose;
    const possible = now.trees !== null && measurable(now),
      cancelled = possible && seen && !now.wantsMap;
    again.hidden = !cancelled;
    state.textContent = !now.trees
      ? 'The map comes when the trees are built.'
      : !measurable(now)
        ? 'A map needs the triangles of both bodies, and one of these trees holds none: open its mesh instead.'
        : cancelled && (stale || !bite)
          ? 'The map was cancelled.'
          : stale
            ? 'Grey: the map of another pose. It is made again where the pose rests.'
            : bite
              ? 'The map is of this pose.'
              : 'The map is being made.';
    answer.classList.toggle('stale', stale);
  };
  const fillBite = () => {
    const {bite} = store.get();
    const word = unitWord(unitOf(store.get()));
    caveat.textContent = bite ? bite.bite.caveat : '';
    answer.replaceChildren(...(bite ? [legend(bite, word), areaFacts(bite.bite, word), contactTable(bite.bite, word, view.choose)] : []));
    fill();
  };
  store.subscribe(['bite', 'bodies'], fillBite);
  store.subscribe(['pose', 'trees', 'preset', 'reach', 'unit', 'frame', 'book', 'wantsMap'], fill);
  return {
    id: 'occlusion',
    title: 'Occlusion',
    element: panel,
    shown() {
      seen = true;
      store.set({wantsMap: true, book: opens});
      view.show(true);
      fillBite();
    },
    hidden() {
      seen = false;
      store.set({wantsMap: false, book: false});
      view.show(false);
    },
  };
}
