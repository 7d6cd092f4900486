// The page paints before its engine answers, makes its answers again where a pose rests, and follows a hand for a thousand answers
// in the same memory. Times are printed, and none of them fails a test.

import assert from 'node:assert/strict';
import {after, before, test} from 'node:test';

import {closePage, inWorker, openPage, ready, startBrowser} from './browser.mjs';

// Answers of a drag: where memory is looked at first and last.
const early = 200,
  late = 1000;
// Bytes: of the engine's memory, of what it holds, and of what the page's own objects hold.
const mostGrowth = {heap: 1e6, held: 2e5, objects: 1e6};
let browser;

before(async () => {
  browser = await startBrowser();
});
after(() => browser?.close());

/** Milliseconds from the opening of the page to what it painted first; undefined before. */
const firstPaint = (page) => page.evaluate(() => performance.getEntriesByName('first-contentful-paint')[0]?.startTime);

test('paints before its engine answers, and has the built-in jaws then', async () => {
  const without = await openPage(browser, '', {before: inWorker('for (;;);')});
  await without.page.waitForFunction(() => performance.getEntriesByName('first-contentful-paint').length > 0);
  await closePage(without);
  const opened = await openPage(browser);
  await ready(opened.page);
  const [paint, settled] = [await firstPaint(opened.page), await opened.page.evaluate(() => performance.now())];
  assert.ok(paint > 0, `${paint}`);
  console.log(`first paint after ${paint.toFixed(0)} ms, jaws after ${settled.toFixed(0)} ms`);
  await closePage(opened);
});

test('makes the map and the depth again after the pose rests', async () => {
  const opened = await openPage(browser, '#voxel=0.4&panel=occlusion');
  const {page} = opened;
  await page.getByText('The map is of this pose.').waitFor();
  await ready(page);
  const slider = page.getByRole('slider', {name: 'Close along z'});
  await slider.evaluate((element) => {
    element.addEventListener('input', () => {
      window.shown = [window.ist.bite(), window.ist.answer()];
    });
  });
  const begun = performance.now();
  await slider.press('ArrowRight');
  assert.deepEqual(await page.evaluate(() => window.shown), [null, null], 'both are of another pose');
  await page.waitForFunction(() => window.ist.bite() !== null && window.ist.answer() !== null);
  console.log(`map and depth after ${(performance.now() - begun).toFixed(0)} ms`);
  await closePage(opened);
});

test('answers a drag at 0.4 mm a thousand times, in the same memory', async () => {
  const opened = await openPage(browser, '#voxel=0.4&panel=pose', {window: {viewport: {width: 800, height: 500}}});
  const {page} = opened;
  await ready(page);
  const {x, y, width, height} = await page.getByRole('slider', {name: 'Close along z'}).boundingBox();
  // Closes and opens the jaws, once in sixty places.
  let moves = 0;
  const place = () => x + width * (0.85 + 0.14 * Math.sin((Math.PI * moves) / 30));
  const client = await page.context().newCDPSession(page);
  await client.send('Performance.enable');
  const memory = async () => {
    const [heap, held] = await page.evaluate(async () => [window.ist.heap(), await window.ist.memory()]);
    await client.send('HeapProfiler.collectGarbage');
    const {metrics} = await client.send('Performance.getMetrics');
    return {heap, held, objects: metrics.find(({name}) => name === 'JSHeapUsedSize').value};
  };
  await page.mouse.move(place(), y + height / 2);
  await page.mouse.down();
  const answers = () => page.evaluate(() => window.ist.tickTimes().count);
  const dragUntil = async (count) => {
    while ((await answers()) < count) {
      for (let each = 0; each < 10; each++) {
        moves += 1;
        await page.mouse.move(place(), y + height / 2);
      }
    }
    return memory();
  };
  const first = await dragUntil(early);
  const last = await dragUntil(late);
  await page.mouse.up();
  const {count, p50, p99, max} = await page.evaluate(() => window.ist.tickTimes());
  console.log(
    `${count} answers: median ${p50.toFixed(1)} ms, p99 ${p99.toFixed(1)} ms, longest ${max.toFixed(1)} ms; memory ${JSON.stringify(first)} to ${JSON.stringify(last)} bytes`,
  );
  for (const [name, most] of Object.entries(mostGrowth)) {
    assert.ok(first[name] > 1e6, `${name}: ${first[name]}`);
    assert.ok(last[name] - first[name] <= most, `${name} went from ${first[name]} to ${last[name]} bytes`);
  }
  await ready(page);
  await closePage(opened);
});
