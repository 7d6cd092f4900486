// What people with two scans see: open surfaces, in any order, with any axis up, and one file at a time.

import assert from 'node:assert/strict';
import {readFileSync, writeFileSync} from 'node:fs';
import path from 'node:path';
import {test} from 'node:test';

import {depthWords} from '../../src/viewer/page/words.js';
import {
  answer,
  answerOf,
  closePage,
  closedBy,
  dropFiles,
  ist,
  lastPicture,
  linesOf,
  message,
  openPage,
  readout,
  ready,
  setPose,
  showPanel,
} from './browser.mjs';
import {pictureOf} from './pictures.mjs';
import {browser, folder, stage} from './stage.mjs';

/** The triangles of a binary STL file that are wanted, by their middles; with their corners mapped. */
function cut(bytes, wanted, map = (corner) => corner) {
  const kept = [];
  for (let at = 84; at + 50 <= bytes.length; at += 50) {
    const corners = [0, 1, 2].map((k) => [0, 1, 2].map((axis) => bytes.readFloatLE(at + 12 + 12 * k + 4 * axis)));
    const middle = [0, 1, 2].map((axis) => (corners[0][axis] + corners[1][axis] + corners[2][axis]) / 3);
    if (wanted(middle)) kept.push(corners.map(map));
  }
  return stl(kept);
}

function stl(triangles) {
  const bytes = Buffer.alloc(84 + 50 * triangles.length);
  bytes.writeUInt32LE(triangles.length, 80);
  triangles.forEach((corners, t) => corners.flat().forEach((value, k) => bytes.writeFloatLE(value, 84 + 50 * t + 12 + 4 * k)));
  return bytes;
}

const yUp = ([x, y, z]) => [x, z, -y];
const scans = {};
stage(() => {
  ist(folder, 'demo', '--voxel-size', '2', '--keep', '.');
  const [upper, lower] = ['upper_jaw.stl', 'lower_jaw.stl'].map((name) => readFileSync(path.join(folder, name)));
  const teeth = {upper: [upper, ([, , z]) => z < 60], lower: [lower, ([, , z]) => z > 40]};
  for (const [name, [bytes, wanted]] of Object.entries(teeth)) {
    scans[`${name}.stl`] = cut(bytes, wanted);
    scans[`${name}_y.stl`] = cut(bytes, wanted, yUp);
  }
  scans['mandible.stl'] = lower;
  for (const [name, bytes] of Object.entries(scans)) writeFileSync(path.join(folder, name), bytes);
});

/** Drops scans, and waits until both are answered. */
async function openScans(names, fragment = '#voxel=2', window = {}) {
  const opened = await openPage(browser, fragment, {window});
  await ready(opened.page);
  await dropScans(opened.page, names, names);
  return opened;
}

async function dropScans(page, names, both) {
  await dropFiles(
    page,
    names.map((name) => [name, scans[name]]),
  );
  await page.waitForFunction((names) => {
    const {bodies, trees} = window.ist.state();
    return trees !== null && names.every((name) => [bodies.fixed?.name, bodies.moving?.name].includes(name));
  }, both);
  await ready(page);
}

const namesOf = (page) => page.evaluate(() => ['fixed', 'moving'].map((role) => window.ist.state().bodies[role]?.name));

async function showMap(page) {
  await showPanel(page, 'Occlusion');
  await page.getByText('The map is of this pose.').waitFor();
  await ready(page);
}

/** The pixels of the picture: red, green, blue, 255 each. */
async function pixels(page) {
  const png = (await lastPicture(() => pictureOf(page))).toString('base64');
  return page.evaluate(async (text) => {
    const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
    const image = await createImageBitmap(new Blob([bytes], {type: 'image/png'}), {colorSpaceConversion: 'none'});
    const canvas = new OffscreenCanvas(image.width, image.height).getContext('2d');
    canvas.drawImage(image, 0, 0);
    return {width: image.width, height: image.height, data: [...canvas.getImageData(0, 0, image.width, image.height).data]};
  }, png);
}

test('says how deep open scans are, as the command does, and 0 where they are apart', async () => {
  const opened = await openScans(['upper.stl', 'lower.stl']);
  const {page} = opened;
  const asked = ['collide', 'upper.stl', 'lower.stl', '--json'];
  const {line} = await answer(page);
  const [, closed] = linesOf(ist(folder, ...asked, '--voxel-size', `${line.voxel_size[0]}`));
  assert.deepEqual(answerOf(line), answerOf(closed));
  assert.ok(closed.depth_at_vertices > 0 && closed.depth_lower === null);
  const words = depthWords(closed, 'mm');
  assert.match(words, /^≥ [\d.]+ mm \(open scans\)$/);
  assert.equal((await readout(page)).Depth, words);
  for (const panel of ['Accuracy', 'Occlusion']) {
    if (panel === 'Occlusion') await showMap(page);
    else await showPanel(page, panel);
    const text = await page.getByRole('tabpanel', {name: panel}).textContent();
    assert.ok(text.includes(`Depth${words}`), text);
  }
  await setPose(page, closedBy(-5));
  assert.deepEqual([(await readout(page)).Touch, (await readout(page)).Depth], ['apart', '0 mm']);
  await closePage(opened);
});

/** The numbers of pixels of each column, or row, that are no background. */
function drawnBy({width, height, data}, inColumns) {
  const background = data.slice(0, 3).join();
  const counts = new Array(inColumns ? width : height).fill(0);
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      const at = 4 * (y * width + x);
      if (`${data[at]},${data[at + 1]},${data[at + 2]}` !== background) counts[inColumns ? x : y] += 1;
    }
  }
  return counts;
}

/** How many parts of a line are drawn, with nothing between them. */
const partsOf = (counts) => counts.filter((count, at) => count > 0 && !(counts[at - 1] > 0)).length;

for (const [window, sideBySide] of [
  [{width: 1200, height: 600}, true],
  [{width: 320, height: 1000}, false],
]) {
  test(`shows both arches from their teeth, front up, ${sideBySide ? 'side by side' : 'above each other'}, and comes back to that`, async () => {
    // The middle of the mandible's box lies far behind that of the scan.
    const opened = await openScans(['upper.stl', 'mandible.stl'], '#voxel=2', {viewport: window});
    const {page} = opened;
    await showMap(page);
    const picture = () => lastPicture(() => pictureOf(page));
    const first = await picture();
    const drawn = await pixels(page);
    assert.deepEqual([partsOf(drawnBy(drawn, true)), partsOf(drawnBy(drawn, false))], sideBySide ? [2, 1] : [1, 2]);
    // Both looked at from their teeth: triangles near the other body face the viewer. The front of the mesh, its least y, is up.
    const seen = await page.evaluate(
      (layout) => {
        const {bite, bodies} = window.ist.state();
        const turn = ([x, y, z], p) => [0, 1, 2].map((row) => p[row] * x + p[4 + row] * y + p[8 + row] * z);
        return ['fixed', 'moving'].map((role) => {
          const {positions, triangles} = bodies[role],
            {distances} = bite[role],
            place = bite.book[layout][role];
          const sum = [0, 0, 0];
          const corner = (v) => [...positions.subarray(3 * v, 3 * v + 3)];
          for (let t = 0; t < triangles.length; t += 3) {
            const three = [...triangles.subarray(t, t + 3)];
            if (!three.every((v) => Math.abs(distances[v]) < 1)) continue;
            const [a, b, c] = three.map(corner);
            const [u, w] = [b, c].map((each) => each.map((value, axis) => value - a[axis]));
            [u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]].forEach(
              (value, axis) => (sum[axis] += value),
            );
          }
          const length = Math.hypot(...sum);
          return {
            facing: turn(
              sum.map((value) => value / length),
              place,
            )[1],
            front: turn([0, -1, 0], place)[2],
          };
        });
      },
      sideBySide ? 'beside' : 'above',
    );
    for (const {facing} of seen) assert.ok(facing < -0.9, `${facing}`);
    assert.deepEqual(
      seen.map(({front}) => Math.round(front)),
      sideBySide ? [1, 1] : [1, -1],
    );
    const canvas = page.locator('canvas');
    for (const back of [() => canvas.press('Home'), () => page.getByRole('button', {name: 'Occlusal view'}).click()]) {
      await canvas.press('ArrowLeft');
      await canvas.press('+');
      assert.ok(!first.equals(await picture()), 'the view is turned');
      await back();
      assert.ok(first.equals(await picture()), 'it comes back');
    }
    await closePage(opened);
  });
}

test('a file that is dropped alone waits for the other jaw', async () => {
  const opened = await openPage(browser, '#voxel=2');
  const {page} = opened;
  await ready(page);
  await dropFiles(page, [['lower.stl', scans['lower.stl']]]);
  await message(page, /^lower\.stl is open\. Now the other jaw/);
  await ready(page);
  assert.deepEqual((await namesOf(page)).filter(Boolean), ['lower.stl']);
  const {Touch, Contacts, Depth} = await readout(page);
  assert.deepEqual([Touch, Contacts, Depth], ['…', '…', '…']);
  await dropScans(page, ['upper.stl'], ['lower.stl', 'upper.stl']);
  assert.deepEqual(await namesOf(page), ['upper.stl', 'lower.stl']);
  const {line} = await answer(page);
  const [, wanted] = linesOf(ist(folder, 'collide', 'upper.stl', 'lower.stl', '--json', '--voxel-size', `${line.voxel_size[0]}`));
  assert.deepEqual(answerOf(line), answerOf(wanted));
  // The next file begins another pair.
  await dropFiles(page, [['upper.stl', scans['upper.stl']]]);
  await message(page, /^upper\.stl is open\. Now the other jaw/);
  assert.deepEqual((await namesOf(page)).filter(Boolean), ['upper.stl']);
  await closePage(opened);
});

test('finds by itself which jaw moves and along which axis, and swaps them on request', async () => {
  const opened = await openScans(['lower_y.stl', 'upper_y.stl']);
  const {page} = opened;
  assert.deepEqual(await namesOf(page), ['upper_y.stl', 'lower_y.stl']);
  await message(page, /^lower_y\.stl lies below, so it is the moving body, which closes along y\./);
  const closed = await readout(page);
  assert.equal(closed.Touch, 'they touch');
  await page.getByRole('slider', {name: 'Close along y'}).press('Home');
  await ready(page);
  assert.deepEqual((await answer(page)).line.pose, [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -5, 0, 1]);
  assert.equal((await readout(page)).Touch, 'apart');
  await page.keyboard.press('End');
  await ready(page);
  await showPanel(page, 'Bodies');
  await page.getByRole('button', {name: 'Swap', exact: true}).click();
  await page.waitForFunction(() => window.ist.state().bodies.fixed.name === 'lower_y.stl' && window.ist.state().trees !== null);
  await ready(page);
  assert.equal((await readout(page)).Depth, closed.Depth);
  await page.getByRole('slider', {name: 'Close along −y'}).press('Home');
  await ready(page);
  assert.deepEqual((await answer(page)).line.pose, [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 5, 0, 1]);
  assert.equal((await readout(page)).Touch, 'apart');
  // First contact goes the same way.
  await showPanel(page, 'Pose');
  await page.getByRole('button', {name: 'First contact'}).click();
  await message(page, /^First contact at \(/);
  await ready(page);
  const {line} = await answer(page);
  assert.equal(line.touch, 'yes');
  assert.ok(line.pose[13] > 0 && line.pose[13] < 5 && line.pose[14] === 0, `${line.pose}`);
  await closePage(opened);
});

test('marks the place of the first contact in the middle of the picture, until the body moves', async () => {
  const opened = await openPage(browser, '#voxel=2&panel=pose');
  const {page} = opened;
  await ready(page);
  const middle = async () => {
    const {width, height, data} = await pixels(page);
    const at = 4 * (Math.floor(height / 2) * width + Math.floor(width / 2));
    return data.slice(at, at + 3);
  };
  await page.getByRole('button', {name: 'First contact'}).click();
  const text = await message(page, /^First contact at \(/);
  assert.match(text, /^First contact at \(−?[\d.]+, −?[\d.]+, −?[\d.]+\) mm, within [\d.e−]+ mm of this pose\.$/);
  await ready(page);
  await showPanel(page, 'Save'); // without the handles
  assert.deepEqual(await middle(), [0xf0, 0xe4, 0x42]);
  await page.getByRole('slider', {name: 'Close along z'}).press('ArrowLeft');
  await ready(page);
  assert.notDeepEqual(await middle(), [0xf0, 0xe4, 0x42]);
  await closePage(opened);
});

/** A box of 12 triangles, whose upper corners are `top(x)` high. */
function boxOf([x0, y0, z0], [x1, y1], top) {
  const at = (x, y, up) => [x, y, up ? top(x) : z0];
  const square = (a, b, c, d) => [
    [a, b, c],
    [a, c, d],
  ];
  return stl([
    ...square(at(x0, y0, 0), at(x0, y1, 0), at(x1, y1, 0), at(x1, y0, 0)),
    ...square(at(x0, y0, 1), at(x1, y0, 1), at(x1, y1, 1), at(x0, y1, 1)),
    ...square(at(x0, y0, 0), at(x1, y0, 0), at(x1, y0, 1), at(x0, y0, 1)),
    ...square(at(x1, y0, 0), at(x1, y1, 0), at(x1, y1, 1), at(x1, y0, 1)),
    ...square(at(x1, y1, 0), at(x0, y1, 0), at(x0, y1, 1), at(x1, y1, 1)),
    ...square(at(x0, y1, 0), at(x0, y0, 0), at(x0, y0, 1), at(x0, y1, 1)),
  ]);
}

test('draws bands to the pixel, between vertices that are far apart, and hatched where the legend says so', async () => {
  scans['above.stl'] = boxOf([-7, -7, 0], [7, 7], () => 6);
  // From 40 µm in the upper box to 160 µm below it: 0 is at a fifth, and 100 µm at seven tenths.
  scans['below.stl'] = boxOf([-5, -5, -6], [5, 5], (x) => 0.04 - (0.2 * (x + 5)) / 10);
  const opened = await openScans(['above.stl', 'below.stl'], '#voxel=2&theme=light');
  const {page} = opened;
  assert.deepEqual(await namesOf(page), ['above.stl', 'below.stl']);
  await showMap(page);
  // By their hues, for the colours are lit: pale blue, red, purple, and lines of 45 % of the purple.
  const {data} = await pixels(page);
  const counts = {line: 0, overlap: 0, contact: 0, near: 0};
  for (let at = 0; at < data.length; at += 4) {
    const [r, g, b] = data.slice(at, at + 3);
    if (b > r + 14) counts.near += 1;
    else if (r > 1.6 * g && r > 1.6 * b) counts.contact += 1;
    else if (b > 1.3 * g && r > g) counts[r < 100 ? 'line' : 'overlap'] += 1;
  }
  const all = counts.line + counts.overlap + counts.contact + counts.near;
  const shares = Object.fromEntries(Object.entries(counts).map(([name, count]) => [name, count / all]));
  const said = JSON.stringify(counts);
  assert.ok(all > 10_000, said);
  assert.ok(Math.abs(shares.line + shares.overlap - 0.2) < 0.02, said);
  assert.ok(Math.abs(shares.contact - 0.5) < 0.02, said);
  assert.ok(Math.abs(shares.near - 0.3) < 0.02, said);
  assert.ok(Math.abs(counts.line / (counts.line + counts.overlap) - 0.3) < 0.1, said);
  await closePage(opened);
});
