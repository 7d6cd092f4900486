/** What people choose among, by the names that the engine and the address know. */

import {unitNames} from './words.js';

/** @typedef {import('./protocol.js').Policy} Policy */
/** @typedef {import('./protocol.js').Unit} Unit */

/** @type {Unit[]} */
const units = ['mm', 'm', 'inch', 'µm'];

/** @type {Policy[]} from the loosest spheres to the tightest */
export const policies = ['simple', 'table', 'tight', 'slab'];

export const presets = [
  {value: 'scan', words: 'scan: 0 and 100 µm (scans, Beck 2023)'},
  {value: 'owens', words: 'owens: 50 and 350 µm (silicone bites, Owens 2002)'},
  {value: 'biteeye', words: 'biteeye: 9 to 149 µm (silicone bites, BiteEye 2022)'},
  {value: 'paper', words: 'paper: 200 µm (articulating paper, Rovira-Lastra 2026)'},
  {value: 'stl', words: 'stl: 100 to 400 µm (scans, Rovira-Lastra 2026)'},
  {value: 'shim', words: 'shim: 10 µm (shim stock holds)'},
];

/**
 * @param {string} none  words for no unit
 * @returns {{value: Unit | '', words: string}[]}
 */
export function unitChoices(none) {
  return [{value: '', words: none}, ...units.map((value) => ({value, words: unitNames[value]}))];
}
