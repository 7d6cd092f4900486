/** A bite in words: the legend of its map, its areas, shares and checks, and its regions. */

import {button} from '../ui/controls.js';
import {element} from '../ui/element.js';
import {facts, table} from '../ui/table.js';
import {count, depthWords, interval, short} from '../words.js';

/** @typedef {import('../protocol.js').Bite} Bite */
/** @typedef {import('../protocol.js').Line} Line */
/** @typedef {import('../protocol.js').Role} Role */

const names = {fixed: 'fixed', moving: 'moving'};

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
  /** @type {[string, string][]} */
  const lines = [
    ['Touch', bite.touch],
    ['Distance', interval(bite.distance_lower, bite.distance_upper, unit)],
    ['Depth', depthWords(bite, unit)],
    ...bite.fixed.areas.map(
      (/** @type {Line} */ area, /** @type {number} */ at) =>
        /** @type {[string, string]} */ ([
          `Area nearer than ${short(area.micrometres)} µm`,
          `${short(area.area)} and ${short(bite.moving.areas[at].area)} ${square}`,
        ]),
    ),
    ['Area in each other', `${both((side) => short(side.penetrating_area))} ${square}`],
    ['Depth integral', `${both((side) => short(side.depth_integral))} ${unit}³`],
    ['Regions', both((side) => count(side.regions.length))],
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
    element('p', {class: 'quiet'}, "Where there are two numbers, the first is the fixed body's. Shares are geometric; they are no forces."),
    facts(lines),
    element('ul', {class: 'checks'}, ...bite.checks.map((/** @type {string} */ check) => element('li', {}, `${check}.`))),
  );
}

/** @param {Record<string, number>} shares */
function shareWords(shares) {
  const sides = Object.entries(shares).filter(([name]) => name !== 'asymmetry');
  return `${sides.map(([name, share]) => `${name.replace('-', '−')} ${short(share, 3)} %`).join(', ')} (asymmetry ${short(shares.asymmetry, 3)} %)`;
}

/**
 * @param {Line} bite
 * @param {Role} role
 * @param {string} unit
 * @param {(role: Role, point: number[]) => void} onPick
 */
export function regionTable(bite, role, unit, onPick) {
  /** @type {Line[]} */
  const regions = bite[role].regions;
  const title = `Contact regions of the ${names[role]} body`;
  if (regions.length === 0) return element('p', {}, `${title}: none at this pose.`);
  const other = bite[role === 'fixed' ? 'moving' : 'fixed'].regions;
  const rows = regions.map((region, at) => ({region, at})).sort((a, b) => b.region.area - a.region.area);
  return table(
    `${title} (d ≤ ${short(bite.contact)} ${unit})`,
    ['#', `area, ${unit}²`, `least d, ${unit}`, 'share', 'faces'],
    rows.map(({region, at}) => [
      look(`Look at region ${at + 1} of the ${names[role]} body`, String(at + 1), () => onPick(role, region.closest)),
      short(region.area, 3),
      short(region.least_distance, 3),
      `${short(100 * region.share, 3)} %`,
      region.partner === null || !other[region.partner] ? 'unpaired' : `region ${region.partner + 1}`,
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
