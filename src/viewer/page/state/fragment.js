/**
 * The state in the address: `#panel=occlusion&pose=1,0,…&voxel=0.4&policy=slab&preset=scan`. A pose
 * is 16 numbers, column by column.
 */

import {policies as allPolicies, presets as allPresets} from '../choices.js';
import {isRigid} from '../pose.js';

/** @typedef {import('../context.js').State} State */

/** @type {string[]} */
const policies = allPolicies;
const presets = allPresets.map(({value}) => value);
const themes = ['dark', 'light'];

/**
 * @param {string} fragment  with or without its `#`
 * @param {string[]} panels  their ids
 * @returns {{change: Partial<State>, problems: string[]}} a part that it cannot take is passed over,
 *   with a sentence
 */
export function readFragment(fragment, panels) {
  /** @type {any} */
  const change = {};
  /** @type {string[]} */
  const problems = [];
  const parts = new URLSearchParams(fragment.replace(/^#/, ''));
  /**
   * @param {string} name
   * @param {string} wanted
   * @param {(text: string) => object | null} read
   */
  const take = (name, wanted, read) => {
    const text = parts.get(name);
    if (text === null) return;
    const found = read(text);
    if (found) Object.assign(change, found);
    else problems.push(`The address gives ${name}=${text.slice(0, 60)}, which is not ${wanted}: the page starts without it.`);
  };
  take('panel', `one of ${panels.join(', ')}`, (text) => (panels.includes(text) ? {panel: text} : null));
  take('pose', 'a pose (16 numbers, column by column, that turn and shift)', (text) => {
    const pose = text.split(',').map((each) => (each.trim() === '' ? NaN : Number(each)));
    return isRigid(pose) ? {pose} : null;
  });
  take('voxel', 'a voxel size above 0', (text) => (Number(text) > 0 && Number.isFinite(Number(text)) ? {voxelSize: Number(text)} : null));
  take('policy', `one of ${policies.join(', ')}`, (text) => (policies.includes(text) ? {policy: text} : null));
  take('preset', `one of ${presets.join(', ')}`, (text) => (presets.includes(text) ? {preset: text} : null));
  take('theme', 'dark or light', (text) => (themes.includes(text) ? {theme: text} : null));
  take('seed', 'a whole number', (text) => (/^\d{1,9}$/.test(text) ? {seed: Number(text)} : null));
  return {change, problems};
}

/**
 * @param {Readonly<State>} state
 * @returns {string} with its `#`
 */
export function writeFragment(state) {
  const parts = [`panel=${state.panel}`, `pose=${state.pose.join(',')}`];
  if (state.voxelSize !== null) parts.push(`voxel=${Number(state.voxelSize.toPrecision(6))}`);
  if (state.policy !== null) parts.push(`policy=${state.policy}`);
  if (state.preset !== 'scan') parts.push(`preset=${state.preset}`);
  if (state.theme !== null) parts.push(`theme=${state.theme}`);
  if (state.seed !== 1) parts.push(`seed=${state.seed}`);
  return `#${parts.join('&')}`;
}
