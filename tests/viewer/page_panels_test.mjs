// What each panel says, in its own words, of what the engine and the command answer.

import assert from 'node:assert/strict';
import {mkdirSync, readFileSync, writeFileSync} from 'node:fs';
import path from 'node:path';
import {test} from 'node:test';

import {count, infoSentences, interval, nearestWords, short} from '../../src/viewer/page/words.js';
import {answer, answerOf, closePage, closedBy, holding, ist, linesOf, message, openPage, readout, ready} from './browser.mjs';
import {pictureOf} from './pictures.mjs';
import {browser, folder, stage} from './stage.mjs';

const ratio = JSON.parse(readFileSync(new URL('../../src/viewer/page/native_ratio.json', import.meta.url), 'utf8'));
stage(() => {
  ist(folder, 'demo', '--voxel-size', '2', '--keep', '.');
});

const panel = (page, name) => page.getByRole('tabpanel', {name, exact: true});

/** The names and values that a panel lists. */
function facts(page, name) {
  return panel(page, name).evaluate((element) =>
    Object.fromEntries([...element.querySelectorAll('dt')].map((each) => [each.textContent, each.nextElementSibling.textContent])),
  );
}

/** The cells of a table of a panel, row by row. */
function rows(page, caption) {
  return page
    .getByRole('region', {name: caption})
    .evaluate((element) => [...element.querySelectorAll('tbody tr')].map((row) => [...row.children].map((cell) => cell.textContent)));
}

test('Bodies: what ist info says of both, and their trees', async () => {
  const opened = await openPage(browser, '#voxel=2&panel=bodies');
  const {page} = opened;
  await ready(page);
  for (const [role, file] of [
    ['fixed', 'upper_jaw.stl'],
    ['moving', 'lower_jaw.stl'],
  ]) {
    const [, info] = linesOf(ist(folder, 'info', file, '--json'));
    const text = await page.locator(`.body.${role}`).textContent();
    for (const sentence of infoSentences({unit: null, ...info})) assert.ok(text.includes(sentence), `${sentence} in: ${text}`);
    const {leaves} = await page.evaluate((role) => window.ist.state().trees[role], role);
    assert.ok(text.includes(`Leaves${count(leaves)}`) && text.includes('Voxel size2 mm'), text);
  }
  await closePage(opened);
});

test('Bodies: makes the built-in jaws of a number, as the command does', async () => {
  const opened = await openPage(browser, '#voxel=2&panel=bodies');
  const {page} = opened;
  await ready(page);
  await page.getByLabel('Built-in jaws, number').fill('7');
  await page.getByRole('button', {name: 'Make these jaws'}).click();
  await page.waitForFunction(() => window.ist.state().jaws === 7 && window.ist.state().trees !== null);
  await ready(page);
  mkdirSync(path.join(folder, 'seven'));
  ist(folder, 'demo', '--seed', '7', '--voxel-size', '2', '--keep', 'seven');
  const hash = (role) => page.evaluate((role) => window.ist.state().bodies[role].info.source.hash, role);
  for (const [role, file] of [
    ['fixed', 'upper_jaw.stl'],
    ['moving', 'lower_jaw.stl'],
  ]) {
    const [, {source}] = linesOf(ist(folder, 'info', path.join('seven', file), '--json'));
    assert.equal(await hash(role), source.hash);
  }
  assert.match(await page.evaluate(() => location.hash), /&seed=7/);
  assert.match(await panel(page, 'Bodies').textContent(), /Leaves[\d,]+/);
  await closePage(opened);
});

test('Pose: copies the matrix that the command reads', async () => {
  const opened = await openPage(browser, `#voxel=2&panel=pose&pose=${closedBy(-0.6)}`);
  const {page} = opened;
  await ready(page);
  await page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
  await page.getByRole('button', {name: 'Copy the matrix'}).click();
  await message(page, /The matrix is copied/);
  writeFileSync(path.join(folder, 'pose.txt'), await page.evaluate(() => navigator.clipboard.readText()));
  const [, line] = linesOf(ist(folder, 'collide', 'upper_jaw.stl', 'lower_jaw.stl', '--voxel-size', '2', '--matrix', 'pose.txt', '--json'));
  assert.deepEqual(answerOf((await answer(page)).line), answerOf(line));
  await page.evaluate(() => {
    navigator.clipboard.writeText = () => Promise.reject(new Error('no'));
  });
  await page.getByRole('button', {name: 'Copy the matrix'}).click();
  await message(page, /does not let the page copy: the matrix is selected/);
  assert.match(await page.evaluate(() => getSelection().toString()), /^1 0 0 0\n0 1 0 0\n0 0 1 -0\.6\n/);
  await closePage(opened);
});

test('Accuracy: visits seven voxel sizes, or as many as it is let', async () => {
  const opened = await openPage(browser, `#voxel=2&panel=accuracy&pose=${closedBy(-5)}`, {before: holding});
  const {page} = opened;
  await ready(page);
  const visit = page.getByRole('button', {name: 'Visit seven voxel sizes'});
  await page.evaluate(() => {
    window.holds = ({question, asked}) => question === 'build' && asked.voxel_size === 1;
  });
  await visit.click();
  await page.waitForFunction(() => window.held() > 0);
  await page.getByRole('button', {name: 'Stop the visits'}).click();
  await page.evaluate(() => window.release());
  await visit.waitFor();
  await ready(page);
  const fewer = await rows(page, 'Visited at this pose');
  assert.ok(fewer.length >= 1 && fewer.length < 7, `${fewer.length}`);
  await visit.click();
  await visit.waitFor();
  await ready(page);
  const sizes = (await rows(page, 'Visited at this pose')).map(([, size]) => Number(size));
  assert.deepEqual(
    sizes.sort((a, b) => b - a),
    [2, 1.4, 1, 0.7, 0.5, 0.4, 0.3],
  );
  await closePage(opened);
});

test('Accuracy: the numbers of the answer, a point for each voxel size and policy, and the ratio to the command', async () => {
  const opened = await openPage(browser, '#voxel=1&panel=accuracy');
  const {page} = opened;
  await ready(page);
  const {line} = await answer(page);
  const said = await facts(page, 'Accuracy');
  assert.match(said['Time of a query'], /^[\d.,]+ µs, the median of groups of 20 and more$/);
  assert.deepEqual(
    [said['Sphere tests'], said['Leaf pairs'], said.Resolution, said.Distance, said['Nearest points (yellow)'], said.Depth],
    [
      count(line.sphere_tests),
      count(line.leaf_pairs),
      `${short(line.resolution)} mm`,
      interval(line.distance_lower, line.distance_upper, 'mm'),
      nearestWords(line),
      interval(line.depth_lower, line.depth_upper, 'mm'),
    ],
  );
  assert.ok((await panel(page, 'Accuracy').textContent()).includes(`takes ${short(ratio.ratio, 2)} times as long as the program itself`));
  const points = () => panel(page, 'Accuracy').locator('circle.point').count();
  assert.equal(await points(), 1);
  await page.getByLabel('Policy').selectOption('tight');
  await page.waitForFunction(() => window.ist.answer()?.line.spheres === 'tight');
  assert.equal(await points(), 2);
  await page.getByRole('slider', {name: 'Voxel size'}).press('End');
  await page.waitForFunction(() => window.ist.answer()?.line.voxel_size[0] === 2);
  assert.equal(await points(), 3);
  assert.equal(await panel(page, 'Accuracy').locator('circle.point.current').count(), 1);
  const visited = (await rows(page, 'Visited at this pose')).map(([policy, voxels]) => `${policy} ${voxels}`);
  assert.deepEqual([visited[0], visited.slice(1).sort()], ['tight 2', ['slab 1', 'tight 1']]);
  await page.getByRole('button', {name: 'Forget the points'}).click();
  assert.equal(await points(), 0);
  await closePage(opened);
});

test('Tree: nodes of a level, policies beside each other, and a query front by front to its leaf pairs', async () => {
  const opened = await openPage(browser, `#voxel=2&panel=tree&pose=${closedBy(-0.2)}`);
  const {page} = opened;
  await ready(page);
  const {line} = await answer(page);
  await page.getByLabel('tight', {exact: true}).check();
  const level = page.getByRole('region', {name: 'Level 4'});
  await level.getByRole('row', {name: /^tight /}).waitFor();
  const nodes = await page.evaluate(() => ['fixed', 'moving'].map((role) => window.ist.state().trees[role].nodes[4]));
  for (const row of await rows(page, 'Level 4')) assert.equal(row[1], nodes.map(count).join(' and '));
  await page.getByLabel('tight', {exact: true}).uncheck();
  await page.getByLabel('Show', {exact: true}).selectOption('query');
  const first = page.getByRole('region', {name: 'This step'}).getByRole('row', {name: /^slab /});
  await first.waitFor();
  const tests = await first.textContent();
  await page.getByRole('slider', {name: 'Step of the query'}).press('End');
  await page
    .getByRole('region', {name: 'This step'})
    .getByRole('cell', {name: count(line.leaf_pairs), exact: true})
    .first()
    .waitFor();
  assert.notEqual(
    await page
      .getByRole('region', {name: 'This step'})
      .getByRole('row', {name: /^slab /})
      .textContent(),
    tests,
  );
  await closePage(opened);
});

test('Contacts: the most pressed ones, and the force and the torque of all', async () => {
  const opened = await openPage(browser, `#voxel=2&panel=contacts&pose=${closedBy(0)}`);
  const {page} = opened;
  await ready(page);
  const {depths, force} = await page.evaluate(() => {
    const {contacts} = window.ist.state().tick;
    return {depths: [...contacts.depths].sort((a, b) => b - a), force: Math.hypot(...contacts.force)};
  });
  assert.ok(depths.length > 1 && force > 0);
  const said = await facts(page, 'Contacts');
  assert.equal(said.Contacts, count(depths.length));
  assert.equal(said.Contacts, (await readout(page)).Contacts);
  // A spring is pressed by a voxel at most: nothing of the panel may look like the depth.
  assert.doesNotMatch(await panel(page, 'Contacts').textContent(), /deepest|contact depth|depth, mm/i);
  assert.ok(said['Force on the moving body (green)'].startsWith(`${short(force, 3)} N (`), JSON.stringify(said));
  assert.match(said['Torque (pink)'], /^[\d.,e−]+ N mm \(/);
  await page.getByRole('slider', {name: 'Stiffness'}).press('End');
  await page.waitForFunction((before) => Math.hypot(...window.ist.state().tick.contacts.force) > 2 * before, force);
  const stiffer = await page.evaluate(() => Math.hypot(...window.ist.state().tick.contacts.force));
  assert.ok(Math.abs(stiffer / force - 100) < 1e-6, '0.1 to 10 N/mm³');
  assert.ok((await facts(page, 'Contacts'))['Force on the moving body (green)'].startsWith(`${short(stiffer, 3)} N (`));
  const listed = await rows(page, 'most pressed');
  assert.deepEqual(
    listed.map(([, depth]) => depth),
    depths.slice(0, 10).map((depth) => short(depth, 3)),
  );
  await closePage(opened);
});

test('Occlusion: the legend, the areas and the contacts of the bite, grey where the pose is another', async () => {
  const opened = await openPage(browser, `#voxel=2&panel=occlusion&preset=stl&pose=${closedBy(-0.6)}`);
  const {page} = opened;
  await page.getByText('The map is of this pose.').waitFor();
  await ready(page);
  const {bands, bite} = await page.evaluate(() => {
    const {
      bite: {bands, bite},
    } = window.ist.state();
    return {bands, bite};
  });
  const legend = await page.locator('.map-legend li').allTextContents();
  assert.equal(legend.length, bands.length + 1);
  bands.forEach(({words}, at) => assert.ok(legend[at].startsWith(words), legend[at]));
  assert.match(await panel(page, 'Occlusion').locator('.map-legend figcaption').textContent(), /^stl: .*Rovira-Lastra/);
  assert.equal(await page.locator('.caveat').textContent(), bite.caveat);
  const areaOn = (contact, role) => {
    const area = contact[role].reduce((sum, at) => sum + bite[role].regions[at].area, 0);
    return contact[role].length ? short(area, 3) : '–';
  };
  assert.ok(bite.contacts.length > 1);
  assert.deepEqual(
    await rows(page, 'Contacts (d ≤ 0.1 mm)'),
    bite.contacts.map((contact) => [
      String(contact.number),
      areaOn(contact, 'fixed'),
      areaOn(contact, 'moving'),
      short(Math.round(1000 * contact.least_distance)),
      short(100 * contact.share, 3),
    ]),
  );
  const said = await facts(page, 'Occlusion');
  const alone = bite.contacts.filter(({fixed, moving}) => !fixed.length || !moving.length).length;
  assert.equal(said.Contacts, `${count(bite.contacts.length)}, ${count(alone)} of them on one body alone`);
  const both = (at, key) => `${short(bite.fixed.areas[at][key])} and ${short(bite.moving.areas[at][key])} mm²`;
  assert.equal(said['Area within 100 µm or overlapping'], both(0, 'area'));
  assert.equal(said['Area within 100 µm, without the overlap'], both(0, 'area_outside'));
  // A contact that is marked is drawn otherwise; one that is looked at is near.
  const drawn = async () => (await pictureOf(page)).toString('base64');
  const unmarked = await drawn();
  await page.getByRole('button', {name: 'Mark contact 2', exact: true}).click();
  const marked = await drawn();
  assert.notEqual(marked, unmarked);
  await page.getByRole('button', {name: 'Mark contact 1', exact: true}).click();
  assert.notEqual(await drawn(), marked);
  await page.getByRole('button', {name: 'Look at contact 1 on the moving body', exact: true}).click();
  const stale = () => panel(page, 'Occlusion').locator('div.stale').count();
  assert.equal(await stale(), 0);
  // A hand that holds the slider: the old map is grey until it rests.
  const box = await page.getByRole('slider', {name: 'Close along z'}).boundingBox();
  await page.mouse.move(box.x + 0.7 * box.width, box.y + box.height / 2);
  await page.mouse.down();
  await page.getByText('Grey: the map of another pose.').waitFor();
  assert.equal(await stale(), 1);
  assert.equal(await page.locator('#readout .stale dt').textContent(), 'Depth');
  await page.mouse.up();
  await page.getByText('The map is of this pose.').waitFor();
  assert.equal(await stale(), 0);
  await closePage(opened);
});
