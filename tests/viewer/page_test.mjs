// The page in a browser: it loads, its numbers are the command's, and it follows the hand.

import assert from 'node:assert/strict';
import {readFileSync, writeFileSync} from 'node:fs';
import {createServer} from 'node:http';
import path from 'node:path';
import {test} from 'node:test';

import {interval} from '../../src/viewer/page/words.js';
import {
  answer,
  answerOf,
  closePage,
  closedBy,
  inWorker,
  ist,
  linesOf,
  message,
  openPage,
  readout,
  ready,
  setPose,
  settled,
  showPanel,
} from './browser.mjs';
import {browser, folder, stage} from './stage.mjs';

const upper = 'upper_jaw.stl',
  lower = 'lower_jaw.stl';
const turned = [Math.cos(0.02), 0, -Math.sin(0.02), 0, 0, 1, 0, 0, Math.sin(0.02), 0, Math.cos(0.02), 0, 0.5, -0.25, -1.2, 1];
const poses = [closedBy(-5), closedBy(-1.5), closedBy(-0.6), closedBy(0), turned];
stage(() => {
  ist(folder, 'demo', '--voxel-size', '2', '--keep', '.');
  writeFileSync(path.join(folder, 'poses.json'), JSON.stringify(poses.map((pose) => ({pose}))));
});

test('has the built-in jaws at the start', async () => {
  const opened = await openPage(browser);
  await ready(opened.page);
  assert.equal((await answer(opened.page)).line.voxel_size[0], 0.4);
  await closePage(opened);
});

test('lets no request leave, whoever asks', async () => {
  const asked = [];
  const server = createServer((request, response) => {
    asked.push(request.url);
    response.writeHead(200, {'Access-Control-Allow-Origin': '*'}).end();
  });
  await new Promise((resolve) => {
    server.listen(0, '127.0.0.1', resolve);
  });
  const {page, close} = await openPage(browser);
  await page.evaluate((address) => {
    window.refused = [];
    document.addEventListener('securitypolicyviolation', (event) => window.refused.push(event.effectiveDirective));
    fetch(`${address}/fetch`).then(
      () => window.refused.push('a fetch was sent'),
      () => {},
    );
    new Image().src = `${address}/image`;
    const script = document.createElement('script');
    script.src = `${address}/script`;
    document.head.append(script);
    const text = `fetch('${address}/worker').then(() => postMessage('sent'), () => postMessage('worker'))`;
    const worker = new Worker(URL.createObjectURL(new Blob([text])));
    worker.onmessage = ({data}) => window.refused.push(data);
  }, `http://127.0.0.1:${server.address().port}`);
  await page.waitForFunction(() => window.refused.length >= 4);
  const refused = await page.evaluate(() => window.refused);
  await close();
  await new Promise((resolve) => {
    server.close(resolve);
  });
  assert.deepEqual(refused.sort(), ['connect-src', 'img-src', 'script-src-elem', 'worker']);
  assert.deepEqual(asked, []);
});

for (const size of [2, 0.8, 0.4]) {
  test(`answers at five poses as the command does, voxels of ${size} mm`, async () => {
    const [header, ...lines] = linesOf(ist(folder, 'collide', upper, lower, '--voxel-size', `${size}`, '--poses', 'poses.json', '--json'));
    const opened = await openPage(browser, `#voxel=${size}&panel=pose`);
    await ready(opened.page);
    for (const [at, pose] of poses.entries()) {
      await setPose(opened.page, pose);
      const found = await answer(opened.page);
      assert.deepEqual({...found.header, commit: ''}, {...header, commit: ''});
      assert.deepEqual(answerOf(found.line), answerOf({...lines[at], index: 0}));
    }
    await closePage(opened);
  });
}

test('follows a drag of the closing slider until the contacts change', async () => {
  const opened = await openPage(browser);
  const {page} = opened;
  await ready(page);
  assert.equal((await readout(page)).Touch, 'apart');
  const slider = page.getByRole('slider', {name: 'Close along z'});
  const {x, y, width, height} = await slider.boundingBox();
  const at = (dz) => x + width * (1 + dz / 5);
  await page.mouse.move(at(-1.5), y + height / 2);
  await page.mouse.down();
  const seen = [];
  for (let dz = -1.5; dz <= 0.01; dz += 0.1) {
    await page.mouse.move(at(dz), y + height / 2);
    await settled(page);
    seen.push(await readout(page));
  }
  // While the hand still holds the slider.
  assert.equal(seen.at(-1).Touch, 'they touch');
  assert.ok(new Set(seen.map((each) => each.Contacts)).size >= 4, 'contacts change with the drag');
  assert.ok(new Set(seen.map((each) => each.Force)).size >= 4, 'force changes with the drag');
  await page.mouse.up();
  await ready(page);
  const {line} = await answer(page);
  assert.equal(line.touch, 'yes');
  assert.ok(line.depth_lower > 0, `depth ${line.depth_lower}`);
  await page.keyboard.press('Control+z');
  await ready(page);
  assert.deepEqual((await answer(page)).line.pose, closedBy(-1.5));
  await page.keyboard.press('Control+y');
  await ready(page);
  assert.deepEqual(answerOf((await answer(page)).line), answerOf(line));
  await closePage(opened);
});

test('shows at rest what the command answers, not what a frame of a drag knows', async () => {
  const opened = await openPage(browser, '#voxel=0.8');
  const {page} = opened;
  await ready(page);
  for (const dz of [-1.5, -4]) {
    await setPose(page, closedBy(dz));
    const [, line] = linesOf(ist(folder, 'collide', upper, lower, '--voxel-size', '0.8', '--move', `0,0,${dz}`, '--json'));
    const {tick} = await page.evaluate(() => ({
      tick: {lower: window.ist.state().tick.distance_lower, upper: window.ist.state().tick.distance_upper},
    }));
    assert.notDeepEqual(tick, {lower: line.distance_lower, upper: line.distance_upper});
    assert.equal((await readout(page)).Distance, interval(line.distance_lower, line.distance_upper, 'mm'));
    const title = await page.locator('#readout dd').nth(1).getAttribute('title');
    assert.equal(title, `${line.distance_lower} to ${line.distance_upper}`);
  }
  await closePage(opened);
});

test('finds the first contact from the pose that is shown', async () => {
  const opened = await openPage(browser, '#panel=pose&voxel=0.8');
  const {page} = opened;
  await ready(page);
  await page.getByRole('button', {name: 'First contact'}).click();
  await message(page, /^First contact at \(/);
  await ready(page);
  const {line} = await answer(page);
  assert.equal(line.touch, 'yes');
  await setPose(page, closedBy(line.pose[14] - 1e-3));
  assert.equal((await answer(page)).line.touch, 'no');
  await closePage(opened);
});

test('goes on as before where a build is cancelled', async () => {
  // A build of small voxels never ends by itself.
  const opened = await openPage(browser, '#panel=accuracy', {
    before: inWorker(`addEventListener('message', ({data: {asked}}) => {
    while (asked?.voxel_size < 0.3);
  });`),
  });
  const {page} = opened;
  await ready(page);
  const before = await answer(page);
  const voxels = page.getByRole('slider', {name: 'Voxel size'});
  await voxels.focus();
  await page.keyboard.press('Home'); // the smallest
  await page.getByRole('button', {name: 'Cancel'}).click();
  await page.getByRole('button', {name: 'Cancel'}).waitFor({state: 'hidden'});
  await ready(page);
  const after = await answer(page);
  assert.deepEqual(answerOf(after.line), answerOf(before.line));
  assert.equal(await voxels.getAttribute('aria-valuetext'), '0.4 mm');
  // The next questions are of the restored bodies.
  await setPose(page, closedBy(-0.6));
  const [, line] = linesOf(ist(folder, 'collide', upper, lower, '--voxel-size', '0.4', '--move', '0,0,-0.6', '--json'));
  assert.deepEqual(answerOf((await answer(page)).line), answerOf(line));
  await closePage(opened);
});

test('saves what the command reads and writes', async () => {
  const opened = await openPage(browser, `#panel=save&voxel=0.8&pose=${turned.join(',')}`);
  const {page} = opened;
  await ready(page);
  const saved = async (name) => {
    const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', {name, exact: true}).click()]);
    const file = path.join(folder, `saved-${download.suggestedFilename()}`);
    await download.saveAs(file);
    return file;
  };
  const pose = await saved('Pose');
  const [, line] = linesOf(ist(folder, 'collide', upper, lower, '--voxel-size', '0.8', '--poses', pose, '--json'));
  const [, ours] = linesOf(readFileSync(await saved('Answer'), 'utf8'));
  assert.deepEqual(answerOf(ours), answerOf(line));
  const [, again] = linesOf(ist(folder, 'collide', upper, lower, '--voxel-size', '0.8', '--matrix', await saved('Matrix'), '--json'));
  assert.deepEqual(answerOf(again), answerOf(line));
  for (const [name, mesh] of [
    ['Fixed tree', upper],
    ['Moving tree', lower],
  ]) {
    ist(folder, 'build', mesh, '-o', 'built.ist', '--voxel-size', '0.8');
    assert.ok(readFileSync(path.join(folder, 'built.ist')).equals(readFileSync(await saved(name))), name);
  }
  assert.equal(
    readFileSync(await saved('Both bodies'))
      .subarray(0, 4)
      .toString(),
    'glTF',
  );
  assert.equal(
    readFileSync(await saved('Picture'))
      .subarray(1, 4)
      .toString(),
    'PNG',
  );
  await page.getByRole('button', {name: 'Bite', exact: true}).click();
  assert.match(await message(page, /no map of this pose/), /open the panel Occlusion/);
  await showPanel(page, 'Occlusion');
  await page.getByText('The map is of this pose.').waitFor();
  await ready(page);
  await showPanel(page, 'Save');
  const bite = JSON.parse(readFileSync(await saved('Bite'), 'utf8'));
  ist(folder, 'occlusion', upper, lower, '--matrix', await saved('Matrix'), '-o', 'bite.json');
  assert.deepEqual({...bite, commit: ''}, {...JSON.parse(readFileSync(path.join(folder, 'bite.json'), 'utf8')), commit: ''});
  await closePage(opened);
});
