// Every long step has a bar and a button that ends it: the page then is as it was, and goes on.

import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import path from 'node:path';
import {test} from 'node:test';

import {
  answer,
  answerOf,
  closePage,
  closedBy,
  ist,
  inWorker,
  message,
  openPage,
  readout,
  ready,
  setPose,
  settled,
  showPanel,
} from './browser.mjs';
import {browser, folder, stage} from './stage.mjs';

const lower = 'lower_jaw.stl',
  turned = [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, -0.6, 1];
stage(() => {
  ist(folder, 'demo', '--voxel-size', '2', '--keep', '.');
});

// The engine never ends these by itself.
const slowly = inWorker(`addEventListener('message', ({data: {question, asked}}) => {
  const long = question === 'first_contact' || question === 'save_glb' || question === 'save_body' || asked?.name === 'slow.stl' ||
      asked?.seed === 5 || asked?.voxel_size < 0.3 || (question === 'occlusion' && asked.preset === 'owens') ||
      (question === 'touched' && asked.level === 0) || (question === 'collide' && asked.pose[14] === -0.25);
  while (long);
});`);

const panelsOf = {
  'Making the built-in jaws': [
    'Bodies',
    async (page) => {
      await page.getByLabel('Built-in jaws, number').fill('5');
      await page.getByRole('button', {name: 'Make these jaws'}).click();
    },
  ],
  'Reading slow.stl': [
    'Bodies',
    (page) =>
      page
        .locator('.body.moving input[type=file]')
        .setInputFiles({name: 'slow.stl', mimeType: 'model/stl', buffer: readFileSync(path.join(folder, lower))}),
  ],
  'Building both trees': ['Accuracy', (page) => page.getByRole('slider', {name: 'Voxel size'}).press('Home')],
  'Reading the trees': ['Tree', (page) => page.getByRole('slider', {name: 'Level'}).press('Home')],
  'Looking for the first contact': ['Pose', (page) => page.getByRole('button', {name: 'First contact'}).click()],
  'Measuring the distances': ['Occlusion', (page) => page.getByLabel('Preset').selectOption('owens')],
  'Writing both bodies as GLB': ['Save', (page) => page.getByRole('button', {name: 'Both bodies', exact: true}).click()],
  'Writing the tree of the moving': ['Save', (page) => page.getByRole('button', {name: 'Moving tree', exact: true}).click()],
};

/** Waits for the bar of a step, and presses its button. */
async function cancel(page, words) {
  const bar = page.locator('#progress > div').filter({hasText: words});
  await bar.getByRole('progressbar').waitFor();
  await bar.getByRole('button', {name: 'Cancel'}).click();
  await bar.waitFor({state: 'hidden'});
}

for (const [words, [panel, begin]] of Object.entries(panelsOf)) {
  test(`ends on request: ${words}`, async () => {
    const opened = await openPage(browser, '#voxel=2', {before: slowly});
    const {page} = opened;
    await ready(page);
    const before = await answer(page);
    await showPanel(page, panel);
    await ready(page);
    await begin(page);
    await cancel(page, words);
    await ready(page);
    const after = await answer(page);
    assert.deepEqual(after.header, before.header);
    assert.deepEqual(answerOf(after.line), answerOf(before.line));
    // The new engine has what the old one had.
    await setPose(page, turned);
    const {line} = await answer(page);
    assert.deepEqual(line.pose, turned);
    assert.equal(line.voxel_size[0], 2);
    await closePage(opened);
  });
}

test('says that the depth is not known where its search was cancelled, and asks again at the next pose', async () => {
  const opened = await openPage(browser, '#voxel=2&panel=pose', {before: slowly});
  const {page} = opened;
  await ready(page);
  // What is asked at each rest has no bar before a second is over: it would flicker. The timer that shows the bar says its time.
  await page.evaluate(() => {
    const {setTimeout} = window;
    let time = 0;
    window.setTimeout = (call, milliseconds, ...more) =>
      setTimeout(() => {
        time = milliseconds;
        call(...more);
      }, milliseconds);
    new MutationObserver((changes) => {
      if (changes.some(({target}) => !target.hidden)) window.barAfter ??= time;
    }).observe(document.getElementById('progress'), {subtree: true, attributeFilter: ['hidden']});
  });
  await page.evaluate(
    (hash) => {
      location.hash = hash;
    },
    `#pose=${closedBy(-0.25)}`,
  );
  await cancel(page, 'Finding distance and depth');
  const barAfter = await page.evaluate(() => window.barAfter);
  assert.equal(barAfter, 1000);
  await settled(page);
  assert.equal(await answer(page), null);
  const {Touch, Depth} = await readout(page);
  assert.deepEqual([Touch, Depth], ['they touch', 'not known']);
  await showPanel(page, 'Save');
  await page.getByRole('button', {name: 'Answer', exact: true}).click();
  assert.match(await message(page, /was cancelled/), /move the body a little/);
  await setPose(page, closedBy(0));
  assert.match((await readout(page)).Depth, /^[\d.]+ to [\d.]+ mm$/);
  await closePage(opened);
});

test('makes a map that was cancelled where it is asked for, and answers meanwhile', async () => {
  const opened = await openPage(browser, '#voxel=2&panel=occlusion', {before: slowly});
  const {page} = opened;
  await page.getByText('The map is of this pose.').waitFor();
  await ready(page);
  await page.getByLabel('Preset').selectOption('owens');
  await page.getByText('Measuring the distances').waitFor();
  await cancel(page, 'Measuring the distances');
  await page.getByText('The map was cancelled.').waitFor();
  await page.getByRole('slider', {name: 'Close along z'}).press('End');
  await ready(page);
  const {line} = await answer(page);
  assert.ok(Math.abs(line.pose[14]) < 1e-9 && line.touch === 'yes', JSON.stringify(line));
  assert.equal(await page.evaluate(() => window.ist.state().tick.touch), 'yes');
  await page.getByLabel('Preset').selectOption('stl');
  await page.getByRole('button', {name: 'Make the map'}).click();
  await page.getByText('The map is of this pose.').waitFor();
  await ready(page);
  assert.equal(await page.evaluate(() => window.ist.bite().preset.name), 'stl');
  await closePage(opened);
});

test('answers a hand while a map is made, and makes that of the pose where it rests', async () => {
  const opened = await openPage(browser, '#voxel=2&panel=occlusion', {before: slowly});
  const {page} = opened;
  await page.getByText('The map is of this pose.').waitFor();
  await ready(page);
  await page.getByLabel('Preset').selectOption('owens');
  await page.getByText('Measuring the distances').waitFor();
  const {x, y, width, height} = await page.getByRole('slider', {name: 'Close along z'}).boundingBox();
  await page.mouse.move(x + width - 4, y + height / 2);
  await page.mouse.down();
  // The map that was begun never ends.
  await page.waitForFunction(() => window.ist.state().tick.touch === 'yes');
  assert.equal(await page.evaluate(() => window.ist.state().dragging), true);
  await page.getByLabel('Preset').evaluate((list) => {
    list.value = 'stl';
    list.dispatchEvent(new Event('change'));
  });
  await page.mouse.up();
  await page.waitForFunction(() => window.ist.bite()?.preset.name === 'stl');
  await ready(page);
  const {line} = await answer(page);
  assert.deepEqual((await page.evaluate(() => window.ist.bite())).pose, line.pose);
  await closePage(opened);
});

test('draws while it reads a recording, and ends that too', async () => {
  const row = [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1];
  const header = {recording: 3, ist: '1.2.3', dt: 0.001, unit: 0.001, bodies: [{name: 'fixed'}, {name: 'held'}], scene: ''};
  const tick = (number) => ({tick: number, dt: 0.001, device: row, tool: row, wrench: [0, 0, 0, 0, 0, 0], points: []});
  const text = (ticks) => [header, ...Array.from({length: ticks}, (_, at) => tick(at))].map((line) => `${JSON.stringify(line)}\n`).join('');
  const opened = await openPage(browser, '#voxel=2&panel=recording', {
    before: () => {
      // Each tick takes 10 ms to read: all of them take minutes.
      const {parse} = JSON;
      JSON.parse = (line, ...more) => {
        for (const begun = performance.now(); line.startsWith('{"tick":') && performance.now() - begun < 10;);
        return parse(line, ...more);
      };
    },
  });
  const {page} = opened;
  await ready(page);
  const file = (name, ticks) => ({name, mimeType: 'text/plain', buffer: Buffer.from(text(ticks))});
  const field = page.getByLabel('Open a recording');
  await field.setInputFiles(file('long.jsonl', 40_000));
  const bar = page.getByRole('progressbar');
  await bar.waitFor();
  const part = () => bar.evaluate((each) => each.value);
  await page.waitForFunction(() => [...document.querySelectorAll('progress')].some(({value}) => value > 0));
  const early = await part();
  await page.waitForFunction((early) => [...document.querySelectorAll('progress')].some(({value}) => value > early), early);
  await cancel(page, 'Reading long.jsonl');
  assert.equal(await page.evaluate(() => window.ist.playback()), null);
  await field.setInputFiles(file('short.jsonl', 10));
  await page.getByText('10 ticks of').waitFor();
  await ready(page);
  await closePage(opened);
});
