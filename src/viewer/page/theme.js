/** Dark or light: as the system says, until the button says otherwise. */

/** @typedef {import('./context.js').Store} Store */
/** @typedef {import('./view/stage.js').Stage} Stage */

/**
 * @param {Store} store
 * @param {Stage} stage
 * @param {HTMLElement} button
 */
export function followTheme(store, stage, button) {
  const system = matchMedia('(prefers-color-scheme: dark)');
  const shown = () => store.get().theme ?? (system.matches ? 'dark' : 'light');
  const apply = () => {
    const theme = shown();
    document.documentElement.dataset.theme = theme;
    button.textContent = theme === 'dark' ? 'Light' : 'Dark';
    stage.setBackground(getComputedStyle(document.documentElement).getPropertyValue('--view').trim());
  };
  button.addEventListener('click', () => store.set({theme: shown() === 'dark' ? 'light' : 'dark'}));
  system.addEventListener('change', apply);
  store.subscribe(['theme'], apply);
  apply();
}
