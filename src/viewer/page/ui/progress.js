/** The bar of a long step, with the button that ends it. */

import {element, newId} from './element.js';

// What takes less long shows no bar, which would only flicker. What is often asked, and seldom long, waits longer.
const patience = 300,
  longPatience = 1000;

/**
 * @typedef {object} Progress
 * @property {(words: string, cancellable: boolean, seldomLong?: boolean) => void} begin
 * @property {(stage: string, part: number) => void} advance
 * @property {() => void} end
 */

/**
 * @param {HTMLElement} place  of all bars
 * @param {() => void} onCancel
 * @returns {Progress}
 */
export function makeProgress(place, onCancel) {
  const id = newId('doing');
  const words = element('span', {id});
  const bar = element('progress', {max: 1, 'aria-labelledby': id});
  const cancel = element('button', {type: 'button', onclick: onCancel}, 'Cancel');
  const shown = element('div', {hidden: true}, words, bar, cancel);
  place.append(shown);
  let doing = '';
  /** @type {number | undefined} */
  let waiting;
  return {
    begin(what, cancellable, seldomLong = false) {
      doing = what;
      words.textContent = what;
      bar.removeAttribute('value');
      cancel.hidden = !cancellable;
      clearTimeout(waiting);
      if (seldomLong) shown.hidden = true;
      waiting = setTimeout(
        () => {
          shown.hidden = false;
        },
        seldomLong ? longPatience : patience,
      );
    },
    advance(stage, part) {
      words.textContent = stage ? `${doing}: ${stage}` : doing;
      if (part > 0) bar.value = part;
      else bar.removeAttribute('value');
    },
    end() {
      clearTimeout(waiting);
      shown.hidden = true;
    },
  };
}
