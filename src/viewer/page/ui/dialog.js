/** A window over the page, which Escape closes. */

import {element, newId} from './element.js';

/**
 * @param {string} title
 * @param {...Node} content
 */
export function openDialog(title, ...content) {
  const id = newId('dialog');
  const dialog = element(
    'dialog',
    {'aria-labelledby': id, onclose: () => dialog.remove()},
    element('h2', {id}, title),
    ...content,
    element('form', {method: 'dialog'}, element('button', {class: 'primary'}, 'Close')),
  );
  document.body.append(dialog);
  dialog.showModal();
}
