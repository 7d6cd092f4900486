// What people give the page: files, an address, and the data that a command wrote into it. What is
// bad gets a sentence, and the page goes on.

import assert from 'node:assert/strict';
import {readFileSync, truncateSync, writeFileSync} from 'node:fs';
import path from 'node:path';
import {test} from 'node:test';

import {zipSync} from '../../src/viewer/node_modules/three/examples/jsm/libs/fflate.module.js';
import {
  answer,
  answerOf,
  closePage,
  closedBy,
  dropFiles,
  inWorker,
  ist,
  linesOf,
  message,
  messages,
  openPage,
  readout,
  ready,
  setPose,
  showPanel,
} from './browser.mjs';
import {browser, folder, stage} from './stage.mjs';

const upper = 'upper_jaw.stl',
  lower = 'lower_jaw.stl';
const coarse = '#voxel=2&panel=bodies';
stage(() => {
  ist(folder, 'demo', '--voxel-size', '2', '--keep', '.');
});

const fileOf = (name, buffer) => ({name, mimeType: 'application/octet-stream', buffer: Buffer.from(buffer)});
const field = (page, role) => page.locator(`.body.${role} input[type=file]`);

/** A binary STL file whose every number is scaled. */
function scaled(name, factor) {
  const bytes = Buffer.from(readFileSync(path.join(folder, name)));
  for (let at = 84; at + 50 <= bytes.length; at += 50) {
    for (let k = 3; k < 12; k++) bytes.writeFloatLE(bytes.readFloatLE(at + 4 * k) * factor, at + 4 * k);
  }
  return bytes;
}

test('says what is wrong with each bad file and what to do, and keeps the bodies that it has', async () => {
  ist(folder, 'build', lower, '-o', 'whole.ist', '--voxel-size', '2');
  writeFileSync(path.join(folder, 'cut.ist'), readFileSync(path.join(folder, 'whole.ist')).subarray(0, 3000));
  const bad = [
    [
      'half.stl',
      readFileSync(path.join(folder, upper)).subarray(0, 5000),
      /byte 5000: the file ends after 98 of the \d+ facets.*; copy or export it again$/,
    ],
    ['empty.ply', '', /the file is empty; export the mesh again$/],
    [
      'numbers.obj',
      'v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n',
      /line 2: the coordinate 'nan' is not finite.*; repair the mesh where it was made$/,
    ],
    ['points.obj', 'v 0 0 0\nv 1 0 0\nv 0 1 0\n', /3 vertices, but no face; export the surface as polygons$/],
    ['cut.ist', readFileSync(path.join(folder, 'cut.ist')), /it has 3000 bytes and should have \d+: copy or build it again$/],
    ['jaw.step', 'ISO-10303-21;', /the file's format is STEP, .*; export the mesh as one of them$/],
    ['jaws.3mf', 'PK\x03\x04'.padEnd(40, '\0'), /invalid zip data\. Export the mesh as STL, PLY or OBJ/],
    ['<script>fault()<!--.stl', 'solid nothing\nendsolid nothing\n', /the STL has no facet; export the mesh again$/],
  ];
  const opened = await openPage(browser, coarse);
  const {page} = opened;
  await ready(page);
  const before = await answer(page);
  for (const [name, content, whatToDo] of bad) {
    await field(page, 'moving').setInputFiles(fileOf(name, content));
    const text = await message(page, name);
    assert.ok(text.startsWith(`${name}: `), text);
    assert.match(text, whatToDo);
  }
  await ready(page);
  assert.deepEqual(answerOf((await answer(page)).line), answerOf(before.line));
  await setPose(page, closedBy(-0.6));
  const [, line] = linesOf(ist(folder, 'collide', upper, lower, '--voxel-size', '2', '--move', '0,0,-0.6', '--json'));
  assert.deepEqual(answerOf((await answer(page)).line), answerOf(line));
  await closePage(opened);
});

test('opens files that are chosen as the command opens them', async () => {
  const opened = await openPage(browser, coarse);
  const {page} = opened;
  await ready(page);
  const small = scaled(lower, 0.5),
    large = scaled(upper, 0.5);
  writeFileSync(path.join(folder, 'small.stl'), small);
  writeFileSync(path.join(folder, 'large.stl'), large);
  await field(page, 'fixed').setInputFiles(fileOf('large.stl', large));
  await page.waitForFunction(() => window.ist.state().bodies.fixed.name === 'large.stl');
  await field(page, 'moving').setInputFiles(fileOf('small.stl', small));
  await page.waitForFunction(() => window.ist.state().bodies.moving.name === 'small.stl');
  await page.waitForFunction(() => window.ist.state().trees !== null);
  await ready(page);
  const found = await answer(page);
  const [header, line] = linesOf(ist(folder, 'collide', 'large.stl', 'small.stl', '--voxel-size', `${found.line.voxel_size[0]}`, '--json'));
  assert.deepEqual(answerOf(found.line), answerOf(line));
  assert.deepEqual({...found.header, commit: ''}, {...header, commit: ''});
  await closePage(opened);
});

test('takes two meshes that are dropped together, the first as fixed', async () => {
  const opened = await openPage(browser, coarse);
  const {page} = opened;
  await ready(page);
  await page.getByLabel('Unit of the files you open').selectOption('mm');
  await dropFiles(page, [
    ['first.stl', scaled(upper, 0.25)],
    ['second.stl', scaled(lower, 0.25)],
  ]);
  await page.waitForFunction(() => window.ist.state().bodies.moving?.name === 'second.stl' && window.ist.state().trees !== null);
  await ready(page);
  const {fixed, moving} = await page.evaluate(() => window.ist.state().bodies);
  assert.deepEqual([fixed.name, fixed.unit, moving.unit], ['first.stl', 'mm', 'mm']);
  await closePage(opened);
});

test('warns where one body is in metres', async () => {
  const opened = await openPage(browser, coarse);
  await ready(opened.page);
  await field(opened.page, 'moving').setInputFiles(fileOf('metres.stl', scaled(lower, 1e-3)));
  await message(opened.page, /in metres/);
  await ready(opened.page);
  await closePage(opened);
});

test('asks for the unit where both bodies are in metres, and takes it', async () => {
  const opened = await openPage(browser, coarse);
  const {page} = opened;
  await ready(page);
  await field(page, 'fixed').setInputFiles(fileOf('upper.stl', scaled(upper, 1e-3)));
  await message(page, /upper\.stl is .* times as|times as large as upper\.stl/);
  await field(page, 'moving').setInputFiles(fileOf('lower.stl', scaled(lower, 1e-3)));
  assert.match(await message(page, /^lower\.stl/), /no unit is known.*If these are metres, choose metres/);
  await page.waitForFunction(() => window.ist.state().bodies.moving.name === 'lower.stl' && window.ist.state().trees !== null);
  await ready(page);
  await page.getByLabel('Unit of the files you open').selectOption('m');
  while ((await messages(page)).length > 0) await page.getByRole('button', {name: 'Close this message'}).first().click();
  await field(page, 'fixed').setInputFiles(fileOf('upper.stl', scaled(upper, 1e-3)));
  await field(page, 'moving').setInputFiles(fileOf('lower.stl', scaled(lower, 1e-3)));
  await page.waitForFunction(() => window.ist.state().bodies.moving.unit === 'm' && window.ist.state().trees !== null);
  await ready(page);
  assert.deepEqual(await messages(page), []);
  assert.match((await readout(page)).Distance, / m$/);
  await closePage(opened);
});

/** A 3MF of a box of 4 x 2 x 1, whose one build item is shifted along z. */
function boxIn3mf({unit, shift = 0, model = '', config = {}}) {
  const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((i) => `<vertex x="${4 * (i & 1)}" y="${i & 2}" z="${i >> 2}"/>`);
  const sides = '0 2 1 1 2 3 4 5 6 5 7 6 0 1 4 1 5 4 2 6 3 3 6 7 0 4 2 2 4 6 1 3 5 3 7 5'.split(' ');
  const triangles = Array.from({length: 12}, (_, i) => [1, 2, 3].map((k) => `v${k}="${sides[3 * i + k - 1]}"`).join(' '));
  const parts = {
    '[Content_Types].xml':
      '<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>',
    '_rels/.rels':
      '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Target="/3D/box.model" Id="r" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>',
    '3D/box.model':
      `<model unit="${unit}" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02" ${model}><resources><object id="1"><mesh><vertices>${corners.join('')}</vertices>` +
      `<triangles>${triangles.map((triangle) => `<triangle ${triangle}/>`).join('')}</triangles></mesh></object></resources>` +
      `<build><item objectid="1" transform="1 0 0 0 1 0 0 0 1 0 0 ${shift}"/></build></model>`,
    ...config,
  };
  return zipSync(Object.fromEntries(Object.entries(parts).map(([name, text]) => [name, new TextEncoder().encode(text)])));
}

test('opens a 3MF in the unit that it states, and refuses the project of a slicer', async () => {
  const opened = await openPage(browser, coarse);
  const {page} = opened;
  await ready(page);
  await dropFiles(page, [
    ['fixed.3mf', boxIn3mf({unit: 'centimeter'})],
    ['moving.3mf', boxIn3mf({unit: 'millimeter', shift: 14})],
  ]);
  await page.waitForFunction(() => window.ist.state().bodies.moving?.name === 'moving.3mf' && window.ist.state().trees !== null);
  await ready(page);
  assert.match((await readout(page)).Distance, /^4(\.0*)? mm/);
  await field(page, 'fixed').setInputFiles(fileOf('inches.3mf', boxIn3mf({unit: 'inch'})));
  assert.match(await message(page, 'inches.3mf'), /is in inches, and moving\.3mf in millimetres/);
  const modifier = {
    'Metadata/Slic3r_PE_model.config':
      '<config><object id="1"><volume><metadata type="volume" key="volume_type" value="ParameterModifier"/></volume></object></config>',
  };
  await field(page, 'fixed').setInputFiles(fileOf('project.3mf', boxIn3mf({unit: 'inch', config: modifier})));
  assert.match(await message(page, 'project.3mf'), /project of a slicer.*Export the mesh as STL/);
  const production = 'requiredextensions="p" xmlns:p="http://schemas.microsoft.com/3dmanufacturing/production/2015/06"';
  await field(page, 'fixed').setInputFiles(fileOf('production.3mf', boxIn3mf({unit: 'inch', model: production})));
  assert.match(await message(page, 'production.3mf'), /the 3MF extension p is required/);
  await closePage(opened);
});

test('refuses files that no page can hold, and goes on', async () => {
  const opened = await openPage(browser, coarse);
  const {page} = opened;
  await ready(page);
  const mesh = path.join(folder, 'large.ply'),
    recording = path.join(folder, 'large.jsonl');
  for (const [file, bytes] of [
    [mesh, 1.2e9],
    [recording, 6e8],
  ]) {
    writeFileSync(file, '');
    truncateSync(file, bytes); // takes no place on the disk
  }
  await field(page, 'moving').setInputFiles(mesh);
  assert.match(await message(page, /^large\.ply: it has 1,200 MB/), /make its mesh coarser/);
  await showPanel(page, 'Recording');
  await page.getByLabel('Open a recording').setInputFiles(recording);
  assert.match(await message(page, /^large\.jsonl: It has 600 MB/), /record fewer --seconds/);
  await setPose(page, closedBy(0));
  assert.equal((await answer(page)).line.touch, 'yes');
  await closePage(opened);
});

test('says so where memory ends while bodies are built, and builds the next ones', async () => {
  const mostBytes = 110e6; // voxels of 0.8 mm need 100 MB, of 0.2 mm over 200
  const opened = await openPage(browser, '#voxel=0.8&panel=accuracy', {
    before: inWorker(`
    const {grow} = WebAssembly.Memory.prototype;
    WebAssembly.Memory.prototype.grow = function(pages) {
      if (this.buffer.byteLength + pages * 65536 > ${mostBytes}) throw new RangeError('Maximum memory size exceeded');
      return grow.call(this, pages);
    };`),
  });
  const {page} = opened;
  await ready(page);
  const before = await answer(page);
  const voxels = page.getByRole('slider', {name: 'Voxel size'});
  await voxels.press('Home');
  assert.match(await message(page, /memory is full/), /The trees of before are kept: choose another voxel size/);
  await ready(page);
  assert.deepEqual(answerOf((await answer(page)).line), answerOf(before.line));
  await voxels.press('End');
  await page.waitForFunction(() => window.ist.state().voxelSize === 2);
  await ready(page);
  const [, line] = linesOf(ist(folder, 'collide', upper, lower, '--voxel-size', '2', '--move', '0,0,-1.5', '--json'));
  assert.deepEqual(answerOf((await answer(page)).line), answerOf(line));
  await closePage(opened);
});

test('goes on where the engine itself ends', async () => {
  const opened = await openPage(browser, coarse, {
    before: inWorker(`addEventListener('message', ({data}) => {
    if (data.question === 'open' && data.asked.name === 'fatal.stl') Float32Array.prototype.slice = () => { throw new RangeError('Array buffer allocation failed'); };
  });`),
  });
  const {page} = opened;
  await ready(page);
  const before = await answer(page);
  await field(page, 'moving').setInputFiles(fileOf('fatal.stl', readFileSync(path.join(folder, lower))));
  await message(page, /memory is full/);
  await ready(page);
  await setPose(page, closedBy(-0.6));
  await setPose(page, before.line.pose);
  assert.deepEqual(answerOf((await answer(page)).line), answerOf(before.line));
  await closePage(opened);
});

test('maps bodies that are out of reach of each other, where every distance is unknown', async () => {
  const opened = await openPage(browser, `#voxel=2&panel=occlusion&pose=${closedBy(-80)}`);
  const {page} = opened;
  await page.getByText('The map is of this pose.').waitFor();
  await ready(page);
  const {unknown, vertices} = await page.evaluate(() => {
    const {bite} = window.ist.state();
    return {unknown: bite.fixed.distances.filter(Number.isNaN).length, vertices: bite.bite.fixed.vertices};
  });
  assert.equal(unknown, vertices);
  assert.doesNotMatch(await page.getByRole('tabpanel', {name: 'Occlusion'}).textContent(), /NaN|null|undefined|Infinity/);
  await closePage(opened);
});

test('comes back to what its address says', async () => {
  const opened = await openPage(browser, '#voxel=0.8&policy=tight&panel=accuracy');
  const {page} = opened;
  await ready(page);
  await setPose(page, closedBy(-0.3));
  const {line} = await answer(page);
  assert.equal(line.spheres, 'tight');
  const again = await openPage(browser, await page.evaluate(() => location.hash));
  await ready(again.page);
  assert.deepEqual(answerOf((await answer(again.page)).line), answerOf(line));
  assert.equal(await again.page.getByRole('tab', {selected: true}).textContent(), 'Pose');
  await again.page.evaluate(
    (hash) => {
      location.hash = hash;
    },
    `#voxel=2&panel=save&pose=${closedBy(-0.6)}`,
  );
  await again.page.waitForFunction(() => window.ist.state().voxelSize === 2);
  await ready(again.page);
  const pasted = (await answer(again.page)).line;
  assert.deepEqual([pasted.voxel_size[0], pasted.pose], [2, closedBy(-0.6)]);
  assert.equal(await again.page.getByRole('tab', {selected: true}).textContent(), 'Save');
  await closePage(again);
  await closePage(opened);
});

test('starts with its defaults where the address is wrong, and says so', async () => {
  const wrong = [
    ['pose', '1,0,0'],
    ['pose', Array(16).fill('nan').join()],
    ['pose', '2,0,0,0,0,2,0,0,0,0,2,0,0,0,0,1'],
    ['voxel', '-1'],
    ['voxel', 'many'],
    ['policy', 'round'],
    ['panel', 'none'],
  ];
  for (const [name, value] of wrong) {
    const opened = await openPage(browser, `#${name}=${value}`);
    assert.match(await message(opened.page, `The address gives ${name}=`), /starts without it/);
    await closePage(opened);
  }
  const opened = await openPage(browser, '#pose=1,2&voxel=x&panel=%3Cb%3E&%E0%A4%A');
  await ready(opened.page);
  const {line} = await answer(opened.page);
  assert.equal(line.voxel_size[0], 0.4);
  assert.equal((await messages(opened.page)).length, 3);
  await closePage(opened);
});

test('keeps an error before people where warnings follow it', async () => {
  const opened = await openPage(browser, coarse);
  const {page} = opened;
  await ready(page);
  await field(page, 'moving').setInputFiles(fileOf('empty.ply', ''));
  const error = await message(page, 'empty.ply');
  for (const panel of ['a', 'b', 'c', 'd']) {
    await page.evaluate((hash) => {
      location.hash = hash;
    }, `#panel=${panel}`);
    await message(page, `panel=${panel},`);
  }
  const [first, ...warnings] = await messages(page);
  assert.equal(first, error);
  assert.deepEqual(
    warnings.map((each) => /panel=(.)/.exec(each)[1]),
    ['b', 'c', 'd'],
  );
  await closePage(opened);
});

test('tries a voxel size that does not fit, says why, and goes on with its own', async () => {
  const opened = await openPage(browser, '#voxel=0.0001');
  await message(opened.page, /choose another voxel size/);
  await ready(opened.page);
  assert.equal((await answer(opened.page)).line.voxel_size[0], 0.4);
  await closePage(opened);
});

/** The page with data in it, as the command writes it. */
function pageWith(data) {
  const text = typeof data === 'string' ? data : JSON.stringify(data).replaceAll('<', '\\u003c');
  const html = readFileSync(process.env.IST_PAGE, 'utf8');
  const parts = html.split('<script type="application/json" id="ist-data">null</script>');
  assert.equal(parts.length, 2);
  const file = path.join(folder, 'with_data.html');
  writeFileSync(file, parts.join(`<script type="application/json" id="ist-data">${text}</script>`));
  return file;
}

test('shows the bodies of the data in it, whatever their names', async () => {
  const voxels = ['--voxel-size', '0.8'];
  ist(folder, 'build', upper, '-o', 'upper.ist', ...voxels);
  ist(folder, 'build', lower, '-o', 'lower.ist', ...voxels);
  const tree = (file) => readFileSync(path.join(folder, file)).toString('base64');
  const file = pageWith({
    format: 1,
    made_by: 'ist 1.2.3',
    kind: 'bodies',
    pose: closedBy(-0.6),
    missing: ['</script><b>One</b> is not here.'],
    bodies: [
      {role: 'fixed', name: '</script><script>fault()</script>.stl', tree: tree('upper.ist')},
      {role: 'moving', name: 'scans/of $& today/lower.stl', tree: tree('lower.ist')},
    ],
  });
  const opened = await openPage(browser, '#voxel=0.8', {file});
  await ready(opened.page);
  await message(opened.page, '</script><b>One</b> is not here.');
  await showPanel(opened.page, 'Bodies');
  for (const [role, name] of [
    ['fixed', '</script><script>fault()</script>.stl'],
    ['moving', 'scans/of $& today/lower.stl'],
  ]) {
    assert.equal(await opened.page.locator(`.body.${role} strong`).textContent(), name);
  }
  assert.match(await opened.page.locator('#subject').textContent(), /^<.script>.* and scans.of \$& today.lower\.stl$/);
  const [, line] = linesOf(ist(folder, 'collide', 'upper.ist', 'lower.ist', '--move', '0,0,-0.6', '--json'));
  assert.deepEqual(answerOf((await answer(opened.page)).line), answerOf(line));
  await closePage(opened);
});

test('shows the bite that the command measured, with the settings that it was asked with', async () => {
  const asked = ['occlusion', upper, lower, '--move', '0,0,-0.6', '--preset', 'stl', '--reach', '3', '--frame', 'lps', '--unit', 'mm'];
  ist(folder, ...asked, '-o', 'bite.html');
  const opened = await openPage(browser, '#voxel=2', {file: path.join(folder, 'bite.html')});
  const {page} = opened;
  await page.getByText('The map is of this pose.').waitFor();
  await ready(page);
  const [, line] = linesOf(ist(folder, ...asked, '--json'));
  assert.deepEqual({...(await page.evaluate(() => window.ist.bite())), commit: ''}, {...line, commit: ''});
  assert.equal(await page.getByLabel('Preset').inputValue(), 'stl');
  assert.equal(await page.getByLabel('Patient frame').inputValue(), 'lps');
  assert.equal(await page.getByLabel('Reach of the search').getAttribute('aria-valuetext'), '3 mm');
  await closePage(opened);
});

test('shows one body alone, and says that there is no other', async () => {
  ist(folder, 'view', upper, '-o', 'one.html');
  const opened = await openPage(browser, '', {file: path.join(folder, 'one.html')});
  const {page} = opened;
  await ready(page);
  assert.equal(await page.locator('.body.fixed strong').textContent(), upper);
  assert.match(await page.locator('.body.moving').textContent(), /There is none yet/);
  assert.deepEqual(await messages(page), []);
  await closePage(opened);
});

test('shows the built-in jaws where the data in it is newer, damaged or of no tree', async () => {
  const body = (role) => ({role, name: 'a/of $&b.ist', tree: Buffer.from('ISTTREE1 nothing').toString('base64')});
  const bad = [
    [{format: 2, made_by: 'ist 9.9.9', kind: 'bodies', bodies: []}, /newer version \(ist 9\.9\.9\)/],
    ['{"format": 1, "made_by": "ist', /cut off or damaged/],
    [{format: 1, made_by: 'ist 1.2.3', kind: 'bodies', bodies: [{role: 'fixed', name: 'a', tree: '*'}]}, /damaged/],
    [{format: 1, made_by: 'ist 1.2.3', kind: 'bodies', bodies: [body('fixed'), body('moving')]}, /^a\/of \$&b\.ist: /],
    [
      {format: 1, made_by: 'ist 1.2.3', kind: 'bite', occlusion: {preset: 'scan', reach: NaN}, bodies: [body('fixed'), body('moving')]},
      /no preset or reach/,
    ],
    ['{"format": 1, "made_by": "ist 1.2.3", "kind": "bite", "pose": [NaN], "bodies": []}', /damaged/],
    [{format: 1, made_by: 'ist 1.2.3', kind: 'bodies', pose: Array(16).fill(null), bodies: [body('fixed'), body('moving')]}, /pose/],
  ];
  for (const [data, sentence] of bad) {
    const opened = await openPage(browser, '#voxel=2', {file: pageWith(data)});
    await message(opened.page, sentence);
    await ready(opened.page);
    assert.equal((await answer(opened.page)).header.fixed.file, upper);
    await closePage(opened);
  }
});

test('refuses recordings of another version, and files that hold no recording', async () => {
  const opened = await openPage(browser, '#voxel=2&panel=recording');
  const {page} = opened;
  await ready(page);
  const header = {recording: 99, ist: '9.9.9', dt: 0.001, unit: 0.001, bodies: []};
  const bad = [
    ['newer.jsonl', `${JSON.stringify(header)}\n`, /^newer\.jsonl: .*version 99.* open it in a page of the version of ist that wrote it/],
    ['none.jsonl', 'no json\n', /^none\.jsonl: .*first line is no JSON\. Record one/],
    ['empty.jsonl', '', /^empty\.jsonl: .*empty.*ist run/],
    ['ticks.csv', 'tick,dt\n1,2\n', /^ticks\.csv: .*CSV.*record JSON lines/],
    ['number.jsonl', '7\n', /^number\.jsonl: .*no recording of ist run.*Record one/],
    ['null.jsonl', 'null\n', /^null\.jsonl: .*no recording of ist run.*Record one/],
    ['poor.jsonl', `${JSON.stringify({...header, recording: 3})}\n{"tick": 1}\n`, /^poor\.jsonl: Line 2 .*no tick.*Record the scene again/],
    ['bodiless.jsonl', '{"recording": 3}\n', /^bodiless\.jsonl: .*header .*damaged.*Record the scene again/],
  ];
  for (const [name, text, sentence] of bad) {
    await page.getByLabel('Open a recording').setInputFiles(fileOf(name, text));
    await message(page, sentence);
  }
  await ready(page);
  await closePage(opened);
});
