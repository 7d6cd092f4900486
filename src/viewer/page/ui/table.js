/** Tables: of rows under a head, and of facts, a name and a value a line. */

import {element} from './element.js';

/** @typedef {string | Node} Cell */

/**
 * @param {string} caption
 * @param {string[]} head
 * @param {Cell[][]} rows
 * @returns {HTMLElement} it scrolls sideways where it is wider than its place
 */
export function table(caption, head, rows) {
  return element(
    'div',
    {class: 'scroll', tabindex: 0, role: 'region', 'aria-label': caption},
    element(
      'table',
      {},
      element('caption', {}, caption),
      element('thead', {}, element('tr', {}, ...head.map((cell) => element('th', {scope: 'col'}, cell)))),
      element('tbody', {}, ...rows.map((row) => element('tr', {}, ...row.map((cell) => element('td', {}, cell))))),
    ),
  );
}

/**
 * @param {[string, Cell][]} lines
 * @returns {HTMLElement}
 */
export function facts(lines) {
  return element(
    'dl',
    {class: 'facts'},
    ...lines.map(([name, value]) => element('div', {}, element('dt', {}, name), element('dd', {}, value))),
  );
}
