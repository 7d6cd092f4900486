/** Keys: undo and redo anywhere but in a text, and the picture's own where it has the focus. */

import {moved} from './pose.js';

/** @typedef {import('./context.js').Context} Context */

const turn = 0.08,
  zoom = 0.9;

/** @param {Pick<Context, 'store' | 'stage' | 'history'>} context */
export function listenToKeys({store, stage, history}) {
  document.addEventListener('keydown', (event) => {
    if (!(event.ctrlKey || event.metaKey) || event.altKey || isText(event.target)) return;
    const key = event.key.toLowerCase();
    if (key !== 'z' && key !== 'y') return;
    event.preventDefault();
    if (key === 'y' || event.shiftKey) history.redo();
    else history.undo();
  });
  if (!stage.drawn) return;
  const {surface} = stage;
  surface.tabIndex = 0;
  surface.setAttribute('role', 'img');
  surface.setAttribute(
    'aria-label',
    'Both bodies in 3D. Arrow keys turn the view, plus and minus zoom; with Shift, arrow keys and Page Up and Down move the moving body.',
  );
  surface.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    // On many keyboards the plus is reached by Shift.
    if ((event.shiftKey && moveBody(event.key)) || moveView(event.key)) event.preventDefault();
  });
  surface.addEventListener('keyup', (event) => {
    if (event.key === 'Shift' && store.get().dragging) store.set({dragging: false});
  });
  surface.addEventListener('blur', () => store.set({dragging: false}));

  /** @param {string} key */
  function moveBody(key) {
    const {bodies, facing, pose} = store.get();
    const step = (bodies.moving?.extent ?? 100) / 1000;
    const {up, front} = facing,
      right = [up[1] * front[2] - up[2] * front[1], up[2] * front[0] - up[0] * front[2], up[0] * front[1] - up[1] * front[0]];
    /** @type {Record<string, [number[], number]>} */
    const ways = {
      ArrowLeft: [right, -step],
      ArrowRight: [right, step],
      ArrowUp: [up, step],
      ArrowDown: [up, -step],
      PageUp: [front, -step],
      PageDown: [front, step],
    };
    if (!ways[key]) return false;
    const [way, by] = ways[key];
    store.set({
      pose: moved(
        pose,
        way.map((part) => part * by),
      ),
      dragging: true,
    });
    return true;
  }

  /** @param {string} key */
  function moveView(key) {
    switch (key) {
      case 'ArrowLeft':
        stage.circle(-turn, 0, 1);
        return true;
      case 'ArrowRight':
        stage.circle(turn, 0, 1);
        return true;
      case 'ArrowUp':
        stage.circle(0, -turn, 1);
        return true;
      case 'ArrowDown':
        stage.circle(0, turn, 1);
        return true;
      case '+':
      case '=':
        stage.circle(0, 0, zoom);
        return true;
      case '-':
        stage.circle(0, 0, 1 / zoom);
        return true;
      case 'Home':
        stage.home();
        return true;
      default:
        return false;
    }
  }
}

/** @param {EventTarget | null} target */
function isText(target) {
  return target instanceof HTMLTextAreaElement || (target instanceof HTMLInputElement && ['text', 'number'].includes(target.type));
}
