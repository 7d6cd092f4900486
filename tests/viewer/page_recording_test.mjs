// A recording of `ist run`, played in the page to its last tick: dropped as a file, and in a page that
// `ist view` wrote.

import assert from 'node:assert/strict';
import {readFileSync, writeFileSync} from 'node:fs';
import path from 'node:path';
import {test} from 'node:test';

import {answer, closePage, ist, linesOf, message, messages, openPage, ready, showPanel} from './browser.mjs';
import {mostOff, openView, partOff, pictureOf} from './pictures.mjs';
import {browser, folder, stage} from './stage.mjs';

// A hand closes the jaws until they bite, and draws the lower one a millimetre beyond.
const scene = `unit = "mm"
seconds = 0.3
[fixed]
shape = "upper jaw"
seed = 3
voxel_size = 1
[held]
shape = "lower jaw"
seed = 3
voxel_size = 1
translation = [0, 0, -4]
[device]
kind = "hand"
plan = [{ time = 0, move = [0, 0, 0] }, { time = 0.3, move = [0, 0, 5] }]
[effects.springs]
stiffness = 20000
`;
const last = 299,
  lateTick = 100,
  missingTick = 200;
// The last tick has two contact points: the second is the stronger one.
const points = [
  {position: [0, 0, 0.02], normal: [0, 0, -1], force: [0, 0, -1.5], gap: 5e-6, triangles: [3, 4], bodies: [0, 1]},
  {position: [0.01, 0, 0.02], normal: [0, 0, -1], force: [0, 0, -2.5], gap: 4e-6, triangles: [5, 6], bodies: [0, 1]},
];
let written;

stage(() => {
  writeFileSync(path.join(folder, 'scene.toml'), scene);
  ist(folder, 'run', 'scene.toml', '--unpaced', '--record', 'measured.jsonl');
  // How long a tick took is the machine's: here one takes longer than a period, and one is missed.
  written = linesOf(readFileSync(path.join(folder, 'measured.jsonl'), 'utf8'))
    .filter(({tick}) => tick !== missingTick)
    .map((line) => (line.tick === last ? {...line, steps: 1, points} : line))
    .map((line) => (line.tick === undefined ? line : {...line, late_microseconds: 0, microseconds: line.tick === lateTick ? 1500 : 40}));
  writeFileSync(path.join(folder, 'run.jsonl'), written.map((line) => `${JSON.stringify(line)}\n`).join(''));
  ist(folder, 'view', 'run.jsonl', '--scene', 'scene.toml', '-o', 'run.html');
  ist(folder, 'view', 'run.jsonl', '-o', 'bodiless.html');
});

async function drop(page, name, text) {
  await page.evaluate(
    ({name, text}) => {
      const dropped = new DataTransfer();
      dropped.items.add(new File([text], name));
      document.body.dispatchEvent(new DragEvent('drop', {dataTransfer: dropped, bubbles: true, cancelable: true}));
    },
    {name, text},
  );
}

const recordingText = () => readFileSync(path.join(folder, 'run.jsonl'), 'utf8');
const playback = (page) => page.evaluate(() => window.ist.playback());
const poseOf = (page) => page.evaluate(() => window.ist.state().pose);

/** For `before`: the clock of the page stands between two frames, and goes on by 20 ms with each. */
function frameClock() {
  const {requestAnimationFrame} = window;
  let frames = 0;
  window.requestAnimationFrame = (call) =>
    requestAnimationFrame((time) => {
      frames += 1;
      call(time);
    });
  performance.now = () => 20 * frames;
}

/** Plays from the start to the last tick, and gives the poses at both. The page has a frameClock(). */
async function playToTheEnd(page) {
  assert.deepEqual(await playback(page), {tick: 0, last});
  const start = await poseOf(page);
  await page.getByLabel('Speed').selectOption('0.1');
  await page.evaluate(() => {
    window.seen = new Set();
    const see = () => {
      window.seen.add(window.ist.playback().tick);
      requestAnimationFrame(see);
    };
    see();
  });
  await page.getByRole('button', {name: 'Play', exact: true}).click();
  await page.waitForFunction((last) => window.seen.has(last), last);
  assert.ok((await page.evaluate(() => window.seen.size)) > 10, 'it plays tick after tick');
  await page.getByRole('button', {name: 'Play', exact: true}).waitFor();
  await ready(page);
  return {start, end: await poseOf(page)};
}

/** Where the recording says that the body is, by its way from where the scene places it. */
function placedBy({tool}) {
  const [, first] = written;
  return [0, 1, 2].map((axis) => 1000 * (tool[axis] - first.tool[axis]));
}

async function checkPlayed(page, {start, end}) {
  assert.ok(Math.abs(start[14] + 4) < 0.02, `${start[14]}`);
  // It pushes along z alone, and turns the jaw a little.
  const way = placedBy(written.at(-1))[2];
  assert.ok(way > 0.5 && Math.abs(end[14] - start[14] - way) < 0.1 * way, `${end[14] - start[14]} of ${way} mm`);
  const {line} = await answer(page);
  assert.deepEqual(line.pose, end);
  // What pushes there are pairs of leaves, whose triangles need not touch.
  assert.ok(line.leaf_pairs > 0 && line.distance_upper < 1, JSON.stringify(line));
}

/** The strokes on the time axis of a plot, one for each late tick. */
const lateStrokes = (page) =>
  page
    .locator('figure.plot path.late')
    .first()
    .getAttribute('d')
    .then((strokes) => strokes.match(/M/g)?.length ?? 0);

test('plays a file that is dropped, and a page that the command wrote, to the same last tick', async () => {
  const opened = await openPage(browser, '#voxel=1', {before: frameClock});
  const {page} = opened;
  await ready(page);
  await drop(page, 'run.jsonl', recordingText());
  await page.getByText(`${last} ticks of`).waitFor();
  await ready(page);
  const dropped = await playToTheEnd(page);
  await checkPlayed(page, dropped);
  assert.equal(await lateStrokes(page), 2);
  assert.deepEqual(await messages(page), []);

  const file = path.join(folder, 'run.html');
  const inPage = await openPage(browser, '#voxel=1', {file, before: frameClock});
  await ready(inPage.page);
  assert.equal(await inPage.page.getByRole('tab', {selected: true}).textContent(), 'Recording');
  const fromPage = await playToTheEnd(inPage.page);
  await checkPlayed(inPage.page, fromPage);
  assert.equal(await lateStrokes(inPage.page), 2);
  assert.deepEqual(await messages(inPage.page), []);
  // One reads the places from the scene's text, the other has them of the command.
  for (const at of ['start', 'end']) {
    fromPage[at].forEach((value, i) => assert.ok(Math.abs(value - dropped[at][i]) < 1e-9, `${at}: ${value} and ${dropped[at][i]}`));
  }
  await closePage(inPage);
  await closePage(opened);
});

test('says of a tick that it is late, and what the hand felt', async () => {
  const opened = await openPage(browser, '', {file: path.join(folder, 'run.html')});
  const {page} = opened;
  await ready(page);
  const scrub = page.getByRole('slider', {name: 'Tick', exact: true});
  const facts = () =>
    page.evaluate(() =>
      Object.fromEntries(
        [...document.querySelectorAll('#panels dt')]
          .filter((name) => name.checkVisibility())
          .map((name) => [name.textContent, name.nextElementSibling.textContent]),
      ),
    );
  await scrub.fill(`${lateTick}`);
  assert.match((await facts()).Took, /1500 µs \(late\)|1,500 µs \(late\)/);
  await page.getByRole('button', {name: 'On a tick'}).click();
  assert.doesNotMatch((await facts()).Took, /late/);
  await scrub.fill(`${missingTick}`); // the tick after the one that is missing
  assert.deepEqual(await playback(page), {tick: missingTick + 1, last});
  assert.match((await facts()).Took, /late/);
  await scrub.fill(`${last - 1}`);
  const {wrench} = written.at(-1);
  const force = Math.hypot(...wrench.slice(0, 3));
  assert.ok(force > 0.1);
  assert.ok(
    Math.abs(parseFloat((await facts()).Force.replace('−', '-')) - force) < 0.01 * force,
    `${(await facts()).Force}, not ${force} N`,
  );
  assert.equal((await facts())['Contact points'], '2');
  const rows = page.getByRole('table', {name: /^2 contact points/}).locator('tbody tr');
  assert.deepEqual(await rows.evaluateAll((all) => all.map((row) => [...row.cells].map((cell) => cell.textContent))), [
    ['1', '2.5', '10.00 0.00 20.00', 'fixed, held', '5, 6', '4'],
    ['2', '1.5', '0.00 0.00 20.00', 'fixed, held', '3, 4', '5'],
  ]);
  await page.getByRole('button', {name: 'Look at contact point 1'}).click();
  await ready(page);
  await closePage(opened);
});

test('draws tool and hand apart where the hand draws it', async () => {
  const opened = await openView(browser, {fragment: '#voxel=2', file: path.join(folder, 'run.html')});
  const {page} = opened;
  const apart = page.getByRole('slider', {name: 'Hand drawn away from the tool'});
  const scrub = page.getByRole('slider', {name: 'Tick', exact: true});
  const pictures = [];
  for (const [tick, times] of [
    [0, 50],
    [0, 1],
    [last - 1, 50],
    [last - 1, 1],
  ]) {
    await scrub.fill(`${tick}`);
    await apart.fill(`${times}`);
    pictures.push(await pictureOf(page));
  }
  // At the start the hand is where the tool is; at the end it is farther on.
  assert.ok((await partOff(page, pictures[0], pictures[1])) <= mostOff);
  const off = await partOff(page, pictures[2], pictures[3]);
  assert.ok(off > 0.03, `${off}`);
  await closePage(opened);
});

test('plays what is cut off up to there, and frames alone where the bodies are not known', async () => {
  const opened = await openPage(browser, '#voxel=2&panel=recording', {file: path.join(folder, 'bodiless.html')});
  const {page} = opened;
  await message(page, /The bodies are not in this page/);
  await ready(page);
  await drop(page, 'cut.jsonl', recordingText().slice(0, -40));
  await message(page, /cut off in line 300/);
  assert.deepEqual(await playback(page), {tick: 0, last: last - 1});
  await ready(page);
  const before = await poseOf(page);
  const [header, ...ticks] = written;
  const other = {...header, scene: header.scene.replace('[fixed]', '[[fixed]]\nshape = "box"\n[[fixed]]')};
  await drop(page, 'two.jsonl', [other, ...ticks].map((line) => `${JSON.stringify(line)}\n`).join(''));
  await message(page, /frames alone are drawn/);
  await page.getByRole('button', {name: 'Play', exact: true}).click();
  await page.waitForFunction(() => window.ist.playback().tick === window.ist.playback().last);
  await showPanel(page, 'Bodies');
  await ready(page);
  assert.deepEqual(await poseOf(page), before, 'frames alone move no body');
  await closePage(opened);
});
