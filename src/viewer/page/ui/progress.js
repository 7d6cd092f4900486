/** The bar of a long question, with the button that ends it. */

import {element} from './element.js';

// What takes less long shows no bar, which would only flicker.
const patience = 300;

/**
 * @typedef {object} Progress
 * @property {(words: string, cancellable: boolean) => void} begin
 * @property {(stage: string, part: number) => void} advance
 * @property {() => void} end
 */

/**
 * @param {HTMLElement} place
 * @param {() => void} onCancel
 * @returns {Progress}
 */
export function makeProgress(place, onCancel) {
  const words = element('span', {id: 'progress-words'});
  const bar = element('progress', {max: 1, 'aria-labelledby': 'progress-words'});
  const cancel = element('button', {type: 'button', onclick: onCancel}, 'Cancel');
  place.append(words, bar, cancel);
  let doing = '';
  /** @type {number | undefined} */
  let waiting;
  return {
    begin(what, cancellable) {
      doing = what;
      words.textContent = what;
      bar.removeAttribute('value');
      cancel.hidden = !cancellable;
      clearTimeout(waiting);
      waiting = setTimeout(() => { place.hidden = false; }, patience);
    },
    advance(stage, part) {
      words.textContent = stage ? `${doing}: ${stage}` : doing;
      if (part > 0) bar.value = part;
      else bar.removeAttribute('value');
    },
    end() {
      clearTimeout(waiting);
      place.hidden = true;
    },
  };
}
