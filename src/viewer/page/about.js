/** The window that says what the page is, and whose work is in it. */

import {button} from './ui/controls.js';
import {element, newId} from './ui/element.js';

/**
 * Opens a window over the page. Escape closes it.
 * @param {string} title
 * @param {...Node} content
 */
function openDialog(title, ...content) {
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

/** @param {import('./engine/engine_client.js').EngineClient} engine */
export function openAbout(engine) {
  const {version, target} = engine.figures();
  const notices = element('pre', {hidden: true, tabindex: 0, 'aria-label': 'Notices of third parties'});
  openDialog(
    'About this page',
    element(
      'p',
      {},
      'IST finds where rigid triangle meshes touch, how deep, and how far apart. The engine is in this page, and no request leaves it.',
    ),
    element('p', {}, version ? `${version}, instruction set ${target}.` : 'The engine has not started yet.'),
    element('p', {}, element('strong', {}, 'Research software, not a medical device.'), ' It has not been validated for any clinical use.'),
    button('Licences and notices', () => {
      notices.textContent = document.getElementById('ist-notices')?.textContent ?? '';
      notices.hidden = !notices.hidden;
    }),
    notices,
  );
}
