// Whoever uses the page, and on what: by keys, by touch, on a narrow screen, in the dark, with a
// reader of screens, and where nothing is drawn.

import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {after, before, test} from 'node:test';

import {
  answer,
  axeFile,
  closePage,
  closedBy,
  lastPicture,
  message,
  openPage,
  readout,
  ready,
  setPose,
  showPanel,
  startBrowser,
  until,
} from './browser.mjs';

const coarse = '#voxel=2&panel=pose';
let browser;

before(async () => {
  browser = await startBrowser();
});
after(() => browser?.close());

const panels = (page) => page.getByRole('tab').allTextContents();

/** The serious faults that axe finds in what is shown. */
async function faultsOf(page) {
  const found = await page.evaluate(() => window.axe.run(document, {resultTypes: ['violations']}));
  return found.violations
    .filter(({impact}) => ['serious', 'critical'].includes(impact))
    .map(({id, nodes}) => `${id}: ${nodes.map(({target}) => target.join(' ')).join(', ')}`);
}

for (const theme of ['light', 'dark']) {
  test(`has no serious fault for a reader of screens, ${theme}`, async () => {
    const opened = await openPage(browser, coarse, {window: {colorScheme: theme}});
    const {page} = opened;
    await ready(page);
    assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), theme);
    await page.evaluate(readFileSync(axeFile, 'utf8'));
    for (const title of await panels(page)) {
      await showPanel(page, title);
      await ready(page);
      assert.deepEqual(await faultsOf(page), [], title);
    }
    await page.getByRole('button', {name: 'About'}).click();
    await page.getByRole('button', {name: 'Licences and notices'}).click();
    assert.match(await page.getByRole('dialog').textContent(), /three\.js[^]*Eigen[^]*Highway[^]*xxHash[^]*fmt[^]*musl/);
    assert.deepEqual(await faultsOf(page), [], 'About');
    await page.keyboard.press('Escape');
    assert.equal(await page.getByRole('dialog').count(), 0);
    // An error is read out too.
    await page.getByLabel(/^Open a recording/).setInputFiles({name: 'none.jsonl', mimeType: 'text/plain', buffer: Buffer.from('7')});
    await page.getByRole('alert').waitFor();
    assert.deepEqual(await faultsOf(page), [], 'an error');
    await closePage(opened);
  });
}

test('turns dark and light by its button, and stays so', async () => {
  const opened = await openPage(browser, coarse, {window: {colorScheme: 'light'}});
  const {page} = opened;
  await ready(page);
  const shown = () => page.evaluate(() => [document.documentElement.dataset.theme, getComputedStyle(document.body).backgroundColor]);
  const [, light] = await shown();
  await page.getByRole('button', {name: 'Dark', exact: true}).click();
  const [theme, dark] = await shown();
  assert.equal(theme, 'dark');
  assert.notEqual(dark, light);
  await page.reload();
  await ready(page);
  assert.deepEqual(await shown(), ['dark', dark]);
  await closePage(opened);
});

test('does all by keys', async () => {
  const opened = await openPage(browser, coarse);
  const {page} = opened;
  await ready(page);
  const {keyboard} = page;
  const focused = () =>
    page.evaluate(() => {
      const {activeElement: at} = document;
      return at.getAttribute('aria-label') ?? at.labels?.[0]?.textContent ?? at.textContent;
    });
  /** Goes on by the tabulator to what is named so. */
  const tabTo = async (name) => {
    for (let i = 0; i < 60; i++) {
      if ((await focused()).startsWith(name)) return;
      await keyboard.press('Tab');
    }
    assert.fail(`the tabulator does not come to ${name}`);
  };
  await tabTo('Close along z');
  const before = await page.evaluate(() => window.ist.state().pose[14]);
  for (let i = 0; i < 5; i++) await keyboard.press('ArrowRight');
  await ready(page);
  const after = await page.evaluate(() => window.ist.state().pose[14]);
  assert.ok(after > before, `${before} to ${after}`);
  await keyboard.press('End');
  await ready(page);
  assert.equal((await readout(page)).Touch, 'they touch');
  await tabTo('Pose');
  await keyboard.press('ArrowRight');
  assert.equal(await page.getByRole('tab', {selected: true}).textContent(), 'Accuracy');
  await keyboard.press('ArrowLeft');
  assert.equal(await page.getByRole('tab', {selected: true}).textContent(), 'Pose');
  await tabTo('First contact');
  await keyboard.press('Enter');
  await page.locator('#messages .message').waitFor();
  await ready(page);
  await tabTo('Shift z');
  await keyboard.press('Control+a');
  await keyboard.type('-2');
  await keyboard.press('Enter');
  await ready(page);
  assert.equal(await page.evaluate(() => window.ist.state().pose[14]), -2);
  await page.locator('canvas').focus();
  await keyboard.press('Shift+ArrowUp');
  await ready(page);
  assert.ok(await page.evaluate(() => window.ist.state().pose[14] > -2));
  await keyboard.press('Control+z');
  await ready(page);
  assert.equal(await page.evaluate(() => window.ist.state().pose[14]), -2);
  await closePage(opened);
});

/** The middle of the tip of the upward handle in the picture: of its pixels, the topmost pure blue ones. */
async function upwardHandle(page) {
  const {x, y} = await page.locator('canvas').boundingBox();
  const png = (await lastPicture(() => page.locator('canvas').screenshot())).toString('base64');
  const found = await page.evaluate(async (text) => {
    const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
    const image = await createImageBitmap(new Blob([bytes], {type: 'image/png'}));
    const canvas = new OffscreenCanvas(image.width, image.height).getContext('2d');
    canvas.drawImage(image, 0, 0);
    const {data, width} = canvas.getImageData(0, 0, image.width, image.height);
    const blue = [];
    for (let at = 0; at < data.length; at += 4) {
      if (data[at] < 40 && data[at + 1] < 40 && data[at + 2] > 200) blue.push([(at / 4) % width, Math.floor(at / 4 / width)]);
    }
    return blue[0] && {x: blue[0][0], y: blue[0][1]};
  }, png);
  assert.ok(found, 'the handle is drawn');
  return {x: x + found.x, y: y + found.y + 5};
}

test('moves the body by the handle in the picture', async () => {
  const opened = await openPage(browser, coarse);
  const {page} = opened;
  await ready(page);
  const {x, y} = await upwardHandle(page);
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let up = 1; up <= 20; up++) await page.mouse.move(x, y - up);
  await page.waitForFunction(() => window.ist.state().pose[14] > -1.5);
  assert.equal(await page.evaluate(() => window.ist.state().dragging), true);
  await page.mouse.up();
  await ready(page);
  const {line} = await answer(page);
  assert.equal(line.pose[12], 0);
  assert.ok(line.pose[14] > -1, `${line.pose[14]}`);
  assert.equal(line.touch, 'yes');
  await page.keyboard.press('Control+z');
  await ready(page);
  assert.deepEqual((await answer(page)).line.pose, closedBy(-1.5));
  await closePage(opened);
});

test('fits 400 pixels, and follows a finger', async () => {
  const opened = await openPage(browser, coarse, {window: {viewport: {width: 400, height: 800}, hasTouch: true, isMobile: true}});
  const {page} = opened;
  await ready(page);
  for (const title of await panels(page)) {
    await page.getByRole('tab', {name: title, exact: true}).tap();
    await ready(page);
    const {width, overlong} = await page.evaluate(() => ({
      width: document.documentElement.scrollWidth,
      // A table may be wider than the screen, where it scrolls by itself.
      overlong: [...document.querySelectorAll('button, input, select, textarea, p, h2, h3, dd')]
        .filter((each) => each.checkVisibility() && !each.closest('table') && each.getBoundingClientRect().right > 401)
        .map((each) => each.outerHTML.slice(0, 80)),
    }));
    assert.ok(width <= 400, `${title} is ${width} pixels wide`);
    assert.deepEqual(overlong, [], title);
  }
  const slider = page.getByRole('slider', {name: 'Close along z'});
  await slider.scrollIntoViewIfNeeded();
  const box = await slider.boundingBox();
  await page.touchscreen.tap(box.x + box.width - 3, box.y + box.height / 2);
  await page.waitForFunction(() => window.ist.state().pose[14] > -1.5);
  await ready(page);
  assert.equal((await readout(page)).Touch, 'they touch');
  await closePage(opened);
});

test('turns the picture by a finger', async () => {
  const opened = await openPage(browser, '#voxel=2&panel=save', {
    window: {viewport: {width: 400, height: 800}, hasTouch: true, isMobile: true},
  });
  const {page} = opened;
  await ready(page);
  const picture = () => page.locator('canvas').screenshot();
  const before = await lastPicture(picture);
  const {x, y} = await page.locator('canvas').boundingBox();
  const client = await page.context().newCDPSession(page);
  const touch = (type, dx) =>
    client.send('Input.dispatchTouchEvent', {type, touchPoints: dx === null ? [] : [{x: x + 100 + dx, y: y + 60}]});
  await touch('touchStart', 0);
  for (let dx = 10; dx <= 100; dx += 10) await touch('touchMove', dx);
  await touch('touchEnd', null);
  await until(picture, (turned) => !before.equals(turned));
  assert.equal(await page.evaluate(() => window.ist.state().pose[14]), -1.5);
  await closePage(opened);
});

/** For browsers that give no WebGL2 from the call of that number on. */
const drawsUntil = (calls) => ({
  content: `{
  const {getContext} = HTMLCanvasElement.prototype;
  let calls = 0;
  HTMLCanvasElement.prototype.getContext = function(kind, ...more) {
    if (String(kind).startsWith('webgl') && ++calls > ${calls}) return null;
    return getContext.call(this, kind, ...more);
  };
}`,
});

// The library that draws complains by itself.
for (const [how, calls, complaint] of [
  ['it has no WebGL2', 0, /^$/],
  ['it gives none after all', 1, /^THREE\.WebGLRenderer: [^,]*creating WebGL context\.$/],
]) {
  test(`answers where nothing can be drawn, and says so: ${how}`, async () => {
    const opened = await openPage(browser, coarse, {before: drawsUntil(calls)});
    const {page} = opened;
    await ready(page);
    assert.match(await page.locator('#view').textContent(), /no WebGL2.*use another browser/);
    await setPose(page, closedBy(0));
    assert.equal((await readout(page)).Touch, 'they touch');
    for (const title of await panels(page)) {
      await showPanel(page, title);
      await ready(page);
    }
    assert.match(opened.faults.splice(0).join(), complaint);
    await closePage(opened);
  });
}

test('says so where the picture is lost, and draws on when it comes back', async () => {
  const opened = await openPage(browser, '#voxel=2&panel=save');
  const {page} = opened;
  await ready(page);
  const picture = () => page.locator('canvas').screenshot();
  const before = await lastPicture(picture);
  await page.evaluate(() => {
    window.taken = document.querySelector('canvas').getContext('webgl2').getExtension('WEBGL_lose_context');
    window.taken.loseContext();
  });
  assert.match(await message(page, /The picture stands still/), /numbers go on.*load the page again/);
  await page.getByRole('slider', {name: 'Close along z'}).press('End');
  await ready(page);
  assert.equal((await readout(page)).Touch, 'they touch');
  await page.keyboard.press('Control+z');
  await ready(page);
  await page.evaluate(() => window.taken.restoreContext());
  await message(page, /The picture is back/);
  while ((await page.locator('#messages .message').count()) > 0)
    await page.getByRole('button', {name: 'Close this message'}).first().click();
  await until(picture, (again) => before.equals(again));
  await closePage(opened);
});
