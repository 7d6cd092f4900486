/** Tabs, of which one shows its panel: arrow keys go from tab to tab. */

import {element} from './element.js';

/** @typedef {import('../context.js').Panel} Panel */

/**
 * @param {HTMLElement} bar
 * @param {HTMLElement} place
 * @param {Panel[]} panels
 * @param {(id: string) => void} onPick
 * @returns {(id: string) => void}  shows a panel
 */
export function makeTabs(bar, place, panels, onPick) {
  const tabs = panels.map((panel) =>
    element(
      'button',
      {
        type: 'button',
        role: 'tab',
        id: `tab-${panel.id}`,
        'aria-controls': `panel-${panel.id}`,
        onclick: () => onPick(panel.id),
      },
      panel.title,
    ),
  );
  for (const panel of panels) {
    panel.element.id = `panel-${panel.id}`;
    panel.element.classList.add('panel');
    panel.element.setAttribute('role', 'tabpanel');
    panel.element.setAttribute('aria-labelledby', `tab-${panel.id}`);
    panel.element.hidden = true;
  }
  bar.append(...tabs);
  place.append(...panels.map((panel) => panel.element));
  bar.addEventListener('keydown', (event) => {
    const at = tabs.indexOf(/** @type {HTMLButtonElement} */ (document.activeElement));
    const step = {ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1}[event.key];
    const next =
      event.key === 'Home' ? 0 : event.key === 'End' ? tabs.length - 1 : step === undefined ? -1 : (at + step + tabs.length) % tabs.length;
    if (next < 0) return;
    event.preventDefault();
    onPick(panels[next].id);
    tabs[next].focus();
  });
  /** @type {Panel | null} */
  let shown = null;
  return (id) => {
    const wanted = panels.find((panel) => panel.id === id) ?? panels[0];
    if (wanted === shown) return;
    if (shown) {
      shown.element.hidden = true;
      shown.hidden();
    }
    shown = wanted;
    wanted.element.hidden = false;
    place.scrollTop = 0;
    for (const [at, panel] of panels.entries()) {
      tabs[at].setAttribute('aria-selected', String(panel === wanted));
      tabs[at].tabIndex = panel === wanted ? 0 : -1;
    }
    wanted.shown();
  };
}
