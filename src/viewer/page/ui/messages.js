/** Sentences to people, below the page's head; those who listen to the page hear them. */

import {element} from './element.js';

/** @typedef {'note' | 'warning' | 'error'} Kind */

const most = 4;
// Where there are too many, the least serious goes first, and of those the oldest.
const kinds = /** @type {const} */ (['note', 'warning', 'error']);
const heads = {note: 'Note', warning: 'Warning', error: 'Error'};

/**
 * @param {HTMLElement} place
 * @returns {(text: string, kind?: Kind) => void}
 */
export function makeMessages(place) {
  return (text, kind = 'note') => {
    for (const shown of [...place.children]) {
      if (shown.querySelector('p')?.textContent === text) shown.remove();
    }
    const message = element(
      'div',
      {class: `message ${kind}`, role: kind === 'error' ? 'alert' : 'status'},
      element('strong', {}, heads[kind]),
      element('p', {}, text),
      element('button', {type: 'button', 'aria-label': 'Close this message', onclick: () => message.remove()}, '×'),
    );
    if (place.children.length >= most) place.querySelector(`.${kinds.find((each) => place.querySelector(`.${each}`))}`)?.remove();
    place.append(message);
  };
}
