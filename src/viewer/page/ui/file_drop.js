/** Files: chosen in a window, or dropped on the page. */

import {element, newId} from './element.js';

/**
 * @param {string} label
 * @param {string} accept   endings, with commas between
 * @param {(file: File) => void} onFile
 * @returns {HTMLElement}
 */
export function fileField(label, accept, onFile) {
  const id = newId('file');
  const input = element('input', {
    id,
    type: 'file',
    accept,
    onchange: () => {
      const file = input.files?.[0];
      if (file) onFile(file);
      input.value = ''; // so that the same file can be chosen again
    },
  });
  return element('div', {class: 'control'}, element('label', {for: id}, label), input);
}

/**
 * Takes files that are dropped on a place.
 * @param {HTMLElement} place
 * @param {(files: File[]) => void} onFiles
 */
export function takeDrops(place, onFiles) {
  place.addEventListener('dragover', (event) => {
    if (!event.dataTransfer?.types.includes('Files')) return;
    event.preventDefault();
    event.dataTransfer.dropEffect = 'copy';
    place.classList.add('dropping');
  });
  place.addEventListener('dragleave', (event) => {
    if (!place.contains(/** @type {Node | null} */ (event.relatedTarget))) place.classList.remove('dropping');
  });
  place.addEventListener('drop', (event) => {
    event.preventDefault();
    place.classList.remove('dropping');
    const files = [...(event.dataTransfer?.files ?? [])];
    if (files.length > 0) onFiles(files);
  });
}

/**
 * Gives people a file.
 * @param {string} name
 * @param {Blob} content
 */
export function download(name, content) {
  const address = URL.createObjectURL(content);
  element('a', {href: address, download: name}).click();
  setTimeout(() => URL.revokeObjectURL(address), 60_000);
}
