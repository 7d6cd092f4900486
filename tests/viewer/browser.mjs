// The page in Chromium, as people open it: from a file, without a server.
//
//   IST_PAGE      the page, build/viewer/ist.html
//   IST_CHROMIUM  the browser; by default /usr/bin/chromium

import assert from 'node:assert/strict';
import {createRequire} from 'node:module';
import {pathToFileURL} from 'node:url';

export {answerOf, ist, linesOf} from './command.mjs';

const require = createRequire(new URL('../../src/viewer/package.json', import.meta.url));
const {chromium} = require('playwright-core');
export const axeFile = require.resolve('axe-core/axe.min.js');

// SwiftShader draws where there is no GPU; the rest keeps the browser from asking its maker.
const switches = [
  '--no-sandbox',
  '--use-angle=swiftshader',
  '--enable-unsafe-swiftshader',
  '--disable-background-networking',
  '--no-first-run',
];
// Milliseconds. They end a test that hangs, and nothing else.
const patience = 240_000;

/** The nearest that the built-in jaws come is at 0; below it they open. */
export const closedBy = (dz) => [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, dz, 1];

export function startBrowser() {
  return chromium.launch({executablePath: process.env.IST_CHROMIUM ?? '/usr/bin/chromium', args: switches});
}

/**
 * Opens the page in a window of its own, and gathers what no page may do.
 * @param {import('playwright-core').Browser} browser
 * @param {string} fragment  with its #, or nothing
 * @param {{file?: string, window?: object, before?: (() => void) | {content: string}}} options  `before` runs in the page first
 */
export async function openPage(browser, fragment = '', {file = process.env.IST_PAGE, window = {}, before} = {}) {
  const context = await browser.newContext({viewport: {width: 1200, height: 800}, ...window});
  context.setDefaultTimeout(patience);
  const page = await context.newPage();
  const faults = [],
    requests = [];
  page.on('console', (message) => {
    if (['error', 'warning'].includes(message.type()) && !isDrawingTalk(message.text())) faults.push(message.text());
  });
  page.on('pageerror', (error) => faults.push(String(error)));
  context.on('request', (request) => requests.push(request.url()));
  if (before) await page.addInitScript(before);
  await page.goto(pathToFileURL(file).href + fragment);
  return {page, faults, requests, close: () => context.close()};
}

/** For `before`: a script that runs in each Worker of the page before the Worker's own. */
export function inWorker(script) {
  const wrap = (script) => {
    const {Blob} = window;
    window.Blob = class extends Blob {
      constructor(parts, options) {
        super(options?.type === 'text/javascript' ? [script, ...parts] : parts, options);
      }
    };
  };
  return {content: `(${wrap})(${JSON.stringify(script)});`};
}

// What Chromium says of its own drawing, whatever page draws.
function isDrawingTalk(text) {
  return /GPU stall due to ReadPixels|Automatic fallback to software WebGL/.test(text);
}

/** Asserts that nothing went wrong and nothing left the page, and closes its window. */
export async function closePage({faults, requests, close}) {
  await close();
  assert.deepEqual(faults, []);
  assert.deepEqual(
    requests.filter((address) => !/^(file|blob|data):/.test(address)),
    [],
  );
}

/** For `before`: questions to the engine wait while `window.holds(message)` says so, until `window.release()`; `window.held()` counts them. */
export function holding() {
  const {Worker} = window;
  const waiting = [];
  window.held = () => waiting.length;
  window.release = () => {
    window.holds = undefined;
    for (const send of waiting.splice(0)) send();
  };
  window.Worker = class extends Worker {
    postMessage(message, ...more) {
      if (window.holds?.(message)) waiting.push(() => super.postMessage(message, ...more));
      else super.postMessage(message, ...more);
    }
  };
}

/** Waits until the page says that nothing is asked. It says so every 50 ms; what it said before this call is passed over. */
async function resting(page, answered) {
  await page.evaluate(() => {
    const {dataset} = document.documentElement;
    if (dataset.state === 'ready') dataset.state = 'busy';
  });
  const state = await page.waitForFunction((answered) => {
    const {state} = document.documentElement.dataset;
    const known = !answered || (window.ist && (window.ist.answer() !== null || window.ist.state().trees === null));
    return (state === 'failed' || (state === 'ready' && known)) && state;
  }, answered);
  assert.equal(await state.jsonValue(), 'ready', (await messages(page)).join(' '));
}

/** Waits until each answer is of the pose and the trees that are shown, or there are no trees to ask. */
export const ready = (page) => resting(page, true);

/** Waits until all that was asked is answered. While a hand holds the body, that is not the whole answer. */
export const settled = (page) => resting(page, false);

/** Asks for something again and again until it is as wanted, and gives it. */
export async function until(ask, wanted) {
  for (const begun = performance.now(); ;) {
    const found = await ask();
    if (await wanted(found)) return found;
    assert.ok(performance.now() - begun < patience, 'what is wanted does not come');
  }
}

/** Takes a picture again and again until two in a row are the same: the page then has drawn its last frame. */
export async function lastPicture(take) {
  let before = await take();
  return until(take, (picture) => {
    const same = before.equals(picture);
    before = picture;
    return same;
  });
}

/** The sentences that the page says now. */
export function messages(page) {
  return page.locator('#messages .message p').allTextContents();
}

/** Waits for a sentence, and gives it. */
export async function message(page, pattern) {
  const found = page.locator('#messages .message p').filter({hasText: pattern}).first();
  await found.waitFor();
  return found.textContent();
}

export async function showPanel(page, title) {
  await page.getByRole('tab', {name: title, exact: true}).click();
}

/** Drops files on the page together: names and bytes. */
export function dropFiles(page, files) {
  const texts = files.map(([name, bytes]) => [name, Buffer.from(bytes).toString('base64')]);
  return page.evaluate((texts) => {
    const dropped = new DataTransfer();
    for (const [name, text] of texts) {
      dropped.items.add(new File([Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0))], name));
    }
    document.body.dispatchEvent(new DragEvent('drop', {dataTransfer: dropped, bubbles: true, cancelable: true}));
  }, texts);
}

/** Gives the page a pose as people paste one. */
export async function setPose(page, pose) {
  await showPanel(page, 'Pose');
  await page.getByLabel(/^Matrix/).fill(pose.join(' '));
  await page.getByRole('button', {name: 'Take this matrix'}).click();
  await page.waitForFunction((wanted) => window.ist.state().pose.every((value, at) => value === wanted[at]), pose);
  await ready(page);
}

/** The lines of `ist collide --json`, as the page holds them. */
export function answer(page) {
  return page.evaluate(() => window.ist.answer());
}

/** What a person reads below the picture: Touch, Distance, Depth, Force, Contacts. */
export function readout(page) {
  return page.evaluate(() =>
    Object.fromEntries(
      [...document.querySelectorAll('#readout dt')].map((name) => [name.textContent, name.nextElementSibling.textContent]),
    ),
  );
}
