/** A bite in words: the legend of its map, its areas, shares and checks, and its contacts. */

import {button} from '../ui/controls.js';
import {element} from '../ui/element.js';
import {facts, table} from '../ui/table.js';
import {count, depthWords, interval, millimetresIn, short} from '../words.js';

/** @typedef {import('../protocol.js').Bite} Bite */
/** @typedef {import('../protocol.js').Line} Line */
/** @typedef {import('../protocol.js').Role} Role */

/**
 * @param {Bite} bite
 * @param {string} unit
 */
export function legend({bite, bands, bare}, unit) {
  const {preset, scanner_band_micrometres: band} = bite;
  return element(
    'figure',
    {class: 'map-legend'},
    element('figcaption', {}, `${preset.name}: ${preset.source}. Scanner band ± ${short(band)} µm, assumed.`),
    element(
      'ul',
      {},
      ...bands.map(({colour, words, below_scan_error: below}) =>
        element('li', {}, swatch(colour, below), `${words}${below ? ' (hatched: below the error assumed for scanning)' : ''}`),
      ),
      element('li', {}, swatch(bare, false), `beyond, to the reach of ${short(bite.reach)} ${unit} and farther`),
    ),
  );
}

/**
 * @param {string} colour
 * @param {boolean} hatched
 */
function swatch(colour, hatched) {
  const made = element('span', {class: hatched ? 'swatch hatched' : 'swatch'});
  made.style.backgroundColor = colour;
  return made;
}

/**
 * @param {Line} bite
 * @param {string} unit
 */
export function areaFacts(bite, unit) {
  const both = (/** @type {(side: Line) => string} */ of) => `${of(bite.fixed)} and ${of(bite.moving)}`;
  const square = `${unit}²`;
  /** @type {string[]} */
  const notes = bite.hint ? [`hint: ${bite.hint}`, ...bite.checks] : bite.checks;
  /** @type {[string, string][]} */
  const lines = [
    ['Touch', bite.touch],
    ['Distance', interval(bite.distance_lower, bite.distance_upper, unit)],
    ['Depth', depthWords(bite, unit)],
    ['Area in each other', `${both((side) => short(side.penetrating_area))} ${square}`],
    ...bandFacts(bite, square),
    ['Depth integral', `${both((side) => short(side.depth_integral))} ${unit}³`],
    ['Contacts', contactCount(bite.contacts)],
  ];
  for (const [title, key] of [
    ['Shares by side', 'sides'],
    ['Shares front to back', 'fore_aft'],
  ]) {
    const shares = bite.fixed[key]?.per_cent;
    if (shares) lines.push([title, shareWords(shares)]);
  }
  return element(
    'div',
    {},
    element('p', {class: 'warned', hidden: !bite.warning}, bite.warning ?? ''),
    element('p', {class: 'quiet'}, "Where there are two numbers, the first is the fixed body's. Shares are geometric; they are no forces."),
    facts(lines),
    element('ul', {class: 'checks'}, ...notes.map((note) => element('li', {}, `${note}.`))),
  );
}

/**
 * @param {Line} bite
 * @param {string} square
 * @returns {[string, string][]} of each limit of the preset, the area with the overlap and without it
 */
function bandFacts({fixed, moving}, square) {
  return fixed.areas.flatMap((/** @type {Line} */ area, /** @type {number} */ at) => {
    if (area.micrometres === 0) return [];
    const within = `Area within ${short(area.micrometres)} µm`;
    const both = (/** @type {string} */ key) => `${short(area[key])} and ${short(moving.areas[at][key])} ${square}`;
    return [
      [`${within} or overlapping`, both('area')],
      [`${within}, without the overlap`, both('area_outside')],
    ];
  });
}

/** @param {Line[]} contacts */
function contactCount(contacts) {
  const alone = contacts.filter(({fixed, moving}) => !fixed.length || !moving.length);
  return `${count(contacts.length)}, ${count(alone.length)} of them on one body alone`;
}

/** @param {Record<string, number>} shares */
function shareWords(shares) {
  const sides = Object.entries(shares).filter(([name]) => name !== 'asymmetry');
  return `${sides.map(([name, share]) => `${name.replace('-', '−')} ${short(share, 3)} %`).join(', ')} (asymmetry ${short(shares.asymmetry, 3)} %)`;
}

/**
 * The contacts by their numbers, which the picture shows too.
 * @param {Line} bite
 * @param {string} unit
 * @param {(number: number, role: Role | null) => void} onPick  a contact, and the body on which it is looked at; null: it is marked
 */
export function contactTable(bite, unit, onPick) {
  if (bite.contacts.length === 0) return element('p', {}, 'No contacts.');
  /** @type {(contact: Line, role: Role) => string | Node} */
  const areaOn = (contact, role) => {
    /** @type {number[]} */
    const regions = contact[role];
    if (regions.length === 0) return '–';
    const area = regions.reduce((sum, at) => sum + bite[role].regions[at].area, 0);
    return look(`Look at contact ${contact.number} on the ${role} body`, short(area, 3), () => onPick(contact.number, role));
  };
  return table(
    `Contacts (d ≤ ${short(bite.contact)} ${unit})`,
    ['contact', `fixed area, ${unit}²`, `moving area, ${unit}²`, 'least d, µm', 'share, %'],
    bite.contacts.map((/** @type {Line} */ contact) => [
      look(`Mark contact ${contact.number}`, String(contact.number), () => onPick(contact.number, null)),
      areaOn(contact, 'fixed'),
      areaOn(contact, 'moving'),
      short(Math.round(1000 * millimetresIn(bite.unit) * contact.least_distance)),
      short(100 * contact.share, 3),
    ]),
  );
}

/**
 * @param {string} label
 * @param {string} text
 * @param {() => void} onClick
 */
function look(label, text, onClick) {
  const made = button(text, onClick);
  made.classList.add('small');
  made.setAttribute('aria-label', label);
  return made;
}
