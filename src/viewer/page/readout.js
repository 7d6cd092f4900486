/** Below the picture, whatever panel is shown: the slider that closes the bodies, and the answers at the pose. */

import {middleOf} from './body_box.js';
import {directionWords} from './facing.js';
import {isHere, unitOf} from './follow.js';
import {along, moved} from './pose.js';
import {slider} from './ui/controls.js';
import {element} from './ui/element.js';
import {count, depthWords, interval, short, unitWord} from './words.js';

/** @typedef {import('./context.js').Store} Store */

const touchWords = {yes: 'they touch', no: 'apart', near: 'near: voxels alone are known', unknown: 'not known'};

/**
 * @param {HTMLElement} place
 * @param {Store} store
 */
export function makeReadout(place, store) {
  // How far the body has closed: its middle's way from the home pose.
  const position = () => {
    const {pose, home, facing, bodies} = store.get();
    return along(home, pose, middleOf(bodies.moving), facing.closing);
  };
  const closing = slider({
    label: closingWords(store.get()),
    min: -5,
    max: 0,
    value: 0,
    words: (value) => `${short(value, 3)} ${unitWord(unitOf(store.get()))}`,
    onInput(value) {
      const {pose, facing} = store.get();
      const further = value - position();
      store.set({
        pose: moved(
          pose,
          facing.closing.map((part) => part * further),
        ),
        dragging: true,
      });
    },
    onChange: () => store.set({dragging: false}),
  });
  const touch = cell('Touch'),
    distance = cell('Distance'),
    depth = cell('Depth'),
    force = cell('Force'),
    contacts = cell('Contacts');
  place.append(
    closing.element,
    element('dl', {class: 'readout'}, ...[touch, distance, depth, force, contacts].map((each) => each.element)),
  );

  const fill = () => {
    const state = store.get();
    const {tick, answer, bodies} = state;
    const unit = unitWord(unitOf(state));
    const span = closingSpan(bodies.moving?.extent ?? 110);
    closing.name(closingWords(state));
    closing.range(-span, 0);
    closing.set(position());
    // A tick's distance is only as close as a person sees; at rest all is the command's.
    const rested = isHere(state, answer),
      unknown = !rested && isHere(state, state.cancelled);
    const known = answer && rested ? answer.line : tick;
    touch.set(known ? (touchWords[/** @type {keyof typeof touchWords} */ (known.touch)] ?? known.touch) : '…');
    touch.element.dataset.touch = known?.touch ?? '';
    distance.set(
      known ? interval(known.distance_lower, known.distance_upper, unit) : '…',
      answer && rested ? inFull(answer.line, 'distance') : '',
    );
    depth.set(
      unknown ? 'not known' : answer ? depthWords(answer.line, unit) : '…',
      unknown ? 'Its search was cancelled: it is asked again when the body moves.' : answer && rested ? depthInFull(answer.line) : '',
    );
    depth.element.classList.toggle('stale', !rested && !unknown);
    force.set(tick ? `${short(Math.hypot(...tick.contacts.force), 3)} N` : '…');
    contacts.set(tick ? count(tick.contacts.depths.length) : '…');
  };
  store.subscribe(['tick', 'answer', 'cancelled', 'pose', 'policy', 'home', 'facing', 'bodies', 'unit'], fill);
  fill();
}

/** @param {Readonly<import('./context.js').State>} state */
function closingWords({facing}) {
  return `Close along ${directionWords(facing.closing)}`;
}

/**
 * @param {number} extent
 * @returns {number} how far the slider opens: 5 of a jaw's 110, a round number for any body
 */
export function closingSpan(extent) {
  const rough = (extent * 5) / 110;
  const power = 10 ** Math.floor(Math.log10(rough));
  return power * ([1, 2, 5, 10].find((each) => each * power >= rough * 0.7) ?? 10);
}

/**
 * @param {import('./protocol.js').Line} line
 * @param {string} name
 * @returns {string} both ends with all digits, as `ist collide --json` prints them
 */
function inFull(line, name) {
  const [lower, upper] = [line[`${name}_lower`], line[`${name}_upper`]];
  return lower === null || upper === null || lower === undefined ? '' : `${lower} to ${upper}`;
}

/**
 * @param {import('./protocol.js').Line} line
 * @returns {string} all digits of the depth, or of its lower bound
 */
function depthInFull(line) {
  const {depth_at_vertices: atVertices} = line;
  return inFull(line, 'depth') || (atVertices > 0 ? `${atVertices}: the deepest vertex, for an open surface has no certain depth` : '');
}

/** @param {string} name */
function cell(name) {
  const value = element('dd');
  return {
    element: element('div', {}, element('dt', {}, name), value),
    set: (/** @type {string} */ to, title = '') => {
      value.textContent = to;
      value.title = title;
    },
  };
}
