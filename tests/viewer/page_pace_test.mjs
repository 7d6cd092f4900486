// The first seconds, and a minute of dragging: answers keep up with a hand, and memory does not grow. On
// a machine that does nothing else: the times are a clock's.

import assert from 'node:assert/strict';
import {after, before, test} from 'node:test';

import {closePage, openPage, ready, startBrowser} from './browser.mjs';

const firstPaint = 1000, jawsReady = 5000;  // milliseconds, as all times here
const early = 5_000, late = 60_000;
// Thirty answers a second.
const slowest = 33;
const mapAgain = 2000;
// Bytes: of the engine's memory, of what it holds, and of what the page's own objects hold.
const mostGrowth = {heap: 1e6, held: 2e5, objects: 1e6};
let browser;

before(async () => {
  browser = await startBrowser();
  await drawOnce(browser);
});
after(() => browser?.close());

/** The browser's own start, half a second of it, is over once it has drawn anything. */
async function drawOnce(browser) {
  const page = await browser.newPage();
  await page.setContent('<p>drawn</p>');
  await page.screenshot();
  await page.close();
}

test('paints at once, and has the built-in jaws soon after', async () => {
  const opened = await openPage(browser);
  await ready(opened.page);
  const {paint, settled} = await opened.page.evaluate(() => ({
    paint: performance.getEntriesByName('first-contentful-paint')[0].startTime, settled: performance.now(),
  }));
  console.log(`first paint after ${paint.toFixed(0)} ms, jaws after ${settled.toFixed(0)} ms`);
  assert.ok(paint < firstPaint, `the first paint came after ${paint} ms`);
  assert.ok(settled < jawsReady, `the jaws were ready after ${settled} ms`);
  await closePage(opened);
});

test('makes the map and the depth again soon after the pose rests', async () => {
  const opened = await openPage(browser, '#voxel=0.4&panel=occlusion');
  const {page} = opened;
  await page.getByText('The map is of this pose.').waitFor();
  await ready(page);
  const begun = performance.now();
  await page.getByRole('slider', {name: 'Close along z'}).press('ArrowRight');
  assert.equal(await page.evaluate(() => window.ist.bite()), null);
  await page.waitForFunction(() => window.ist.bite() !== null && window.ist.answer() !== null);
  const taken = performance.now() - begun;
  console.log(`map and depth after ${taken.toFixed(0)} ms`);
  assert.ok(taken < mapAgain, `they took ${taken} ms`);
  await closePage(opened);
});

test('answers a drag at 0.4 mm in time for a minute, in the same memory', async () => {
  const opened = await openPage(browser, '#voxel=0.4&panel=pose', {window: {viewport: {width: 800, height: 500}}});
  const {page} = opened;
  await ready(page);
  const {x, y, width, height} = await page.getByRole('slider', {name: 'Close along z'}).boundingBox();
  // Closes and opens the jaws, once in two seconds.
  const place = (time) => x + width * (0.85 + 0.14 * Math.sin(Math.PI * time / 1000));
  const client = await page.context().newCDPSession(page);
  await client.send('Performance.enable');
  const memory = async () => {
    const [heap, held] = await page.evaluate(async () => [window.ist.heap(), await window.ist.memory()]);
    await client.send('HeapProfiler.collectGarbage');
    const {metrics} = await client.send('Performance.getMetrics');
    return {heap, held, objects: metrics.find(({name}) => name === 'JSHeapUsedSize').value};
  };
  await page.mouse.move(place(0), y + height / 2);
  await page.mouse.down();
  const begun = performance.now();
  const time = () => performance.now() - begun;
  const dragUntil = async (end) => {
    while (time() < end) await page.mouse.move(place(time()), y + height / 2);
    return memory();
  };
  const first = await dragUntil(early);
  const last = await dragUntil(late);
  await page.mouse.up();
  const {count, p50, p99, max} = await page.evaluate(() => window.ist.tickTimes());
  console.log(`${count} answers: median ${p50.toFixed(1)} ms, p99 ${p99.toFixed(1)} ms, longest ${max.toFixed(1)} ms; memory ${JSON.stringify(first)} to ${JSON.stringify(last)} bytes`);
  assert.ok(count > 100, `${count} answers in a minute`);
  assert.ok(p99 < slowest, `of 100 answers one took ${p99} ms or longer`);
  for (const [name, most] of Object.entries(mostGrowth)) {
    assert.ok(first[name] > 1e6, `${name}: ${first[name]}`);
    assert.ok(last[name] - first[name] <= most, `${name} went from ${first[name]} to ${last[name]} bytes`);
  }
  await ready(page);
  await closePage(opened);
});
