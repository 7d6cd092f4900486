// The canvas alone, of a fixed size, and the page of README, beside the pictures that are kept. Where a change of them is meant:
// node scripts/draw_page.mjs tests/viewer/pictures and node scripts/draw_page.mjs docs/pictures/page.png

import assert from 'node:assert/strict';
import {mkdirSync, readFileSync, writeFileSync} from 'node:fs';
import path from 'node:path';
import {after, before, test} from 'node:test';

import {closePage, startBrowser} from './browser.mjs';
import {mostOff, openView, pageDrawn, partOff, pictureOf, views, wholePage} from './pictures.mjs';

const kept = (name) => readFileSync(new URL(`pictures/${name}.png`, import.meta.url));
const ofReadme = () => readFileSync(new URL('../../docs/pictures/page.png', import.meta.url));
let browser;

/** Asserts that few pixels differ; else what is drawn now lies beside the page. */
function assertSame(name, off, drawn) {
  const file = path.resolve(path.dirname(process.env.IST_PAGE), 'pictures', `${name}.png`);
  if (off > mostOff) {
    mkdirSync(path.dirname(file), {recursive: true});
    writeFileSync(file, drawn);
  }
  console.log(`${name}: ${(100 * off).toFixed(3)} % of the pixels differ`);
  assert.ok(
    off <= mostOff,
    `${(100 * off).toFixed(2)} % of the pixels differ: see ${file}. Where that is meant, draw it anew by scripts/draw_page.mjs`,
  );
}

before(async () => {
  browser = await startBrowser();
});
after(() => browser?.close());

for (const view of views) {
  test(`draws as it did: ${view.name}`, async () => {
    const opened = await openView(browser, view);
    const drawn = await pictureOf(opened.page);
    assertSame(view.name, await partOff(opened.page, kept(view.name), drawn), drawn);
    await closePage(opened);
  });
}

test('looks as in the picture that README shows', async () => {
  const {opened, picture} = await pageDrawn(browser);
  const {page} = opened;
  assertSame('page', await partOff(page, ofReadme(), picture, wholePage), picture);
  await page.getByLabel('Preset').selectOption('scan');
  await page.getByText('The map is of this pose.').waitFor();
  const other = await partOff(page, ofReadme(), await page.screenshot(), wholePage);
  assert.ok(other > mostOff, `another preset: ${(100 * other).toFixed(2)} % differ`);
  await closePage(opened);
});

test('tells its pictures apart', async () => {
  const [, contacts] = views;
  const opened = await openView(browser, contacts);
  const {page} = opened;
  const drawn = await pictureOf(page);
  const others = await Promise.all(views.map(({name}) => partOff(page, kept(name), drawn)));
  assert.deepEqual(
    others.map((off) => off > mostOff),
    views.map((view) => view !== contacts),
  );
  await page.getByLabel('See through the bodies').uncheck();
  assert.ok((await partOff(page, drawn, await pictureOf(page))) > mostOff, 'bodies that are seen through');
  await closePage(opened);
});

test('draws the hand apart from the tool', async () => {
  const opened = await openView(
    browser,
    views.find(({name}) => name === 'recording'),
  );
  const {page} = opened;
  const apart = await pictureOf(page);
  await page.getByLabel('Hand drawn away from the tool').fill('1');
  const off = await partOff(page, apart, await pictureOf(page));
  assert.ok(off > mostOff, `${off}`);
  await closePage(opened);
});

test('draws on a dark ground too', async () => {
  const [bodies] = views;
  const opened = await openView(browser, bodies, 'dark');
  const off = await partOff(opened.page, kept(bodies.name), await pictureOf(opened.page));
  assert.ok(off > 0.3, `${off}`);
  await closePage(opened);
});
