// Measures how much slower the page answers than the command, in turns on one machine, and writes
// the figure that the page shows: the median over five poses, at each the median of five rounds.
//
//   IST_COMMAND=build/release/ist node scripts/viewer_ratio.mjs
//
// Both list all leaf pairs of the built-in jaws at 0.4 mm with one worker. scripts/viewer.sh builds
// the engine; node runs the same code as a browser's V8.

import {execFileSync} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import path from 'node:path';
import {fileURLToPath} from 'node:url';

import {startEngine} from '../tests/viewer/engine.mjs';

const root = fileURLToPath(new URL('..', import.meta.url));
const command = path.resolve(process.env.IST_COMMAND ?? path.join(root, 'build/release/ist'));
const voxelSize = 0.4;
const rounds = 5;
const shifts = [-2, -1.5, -1, -0.5, 0];
const question = `collide upper_jaw.stl lower_jaw.stl --voxel-size ${voxelSize} --repeat 100 --json`;
const median = (numbers) => [...numbers].sort((a, b) => a - b)[Math.floor(numbers.length / 2)];

const folder = mkdtempSync(path.join(tmpdir(), 'ist-ratio-'));
try {
  const ist = (...words) => execFileSync(command, words, {cwd: folder, encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore']});
  ist('demo', '--voxel-size', '2', '--keep', '.');
  const engine = await startEngine(path.join(root, 'build/wasm/viewer'));
  engine.ask('make_jaws', {seed: 1});
  engine.ask('build', {voxel_size: voxelSize});
  const rows = shifts.map((dz) => {
    const native = [],
      page = [];
    let commit;
    for (let round = 0; round < rounds; ++round) {
      const lines = ist(...question.split(' '), '--move', `0,0,${dz}`)
        .trimEnd()
        .split('\n');
      const [header, line] = lines.map((text) => JSON.parse(text));
      commit = header.commit;
      native.push(line.microseconds_median);
      page.push(engine.ask('collide', {pose: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, dz, 1]}).microseconds);
    }
    return {dz, commit, native: median(native), page: median(page)};
  });
  for (const {dz, native, page} of rows) {
    console.log(`dz ${dz}: the command ${native.toFixed(1)} µs, the page ${page.toFixed(1)} µs, ${(page / native).toFixed(1)} times`);
  }
  const middle = median(rows.map(({native, page}) => page / native));
  const at = rows.find(({native, page}) => page / native === middle);
  const processor = /model name\s*: (.*)/.exec(readFileSync('/proc/cpuinfo', 'utf8'))?.[1] ?? 'unknown';
  const figure = {
    ratio: Number(middle.toFixed(1)),
    native_microseconds: Number(at.native.toFixed(1)),
    machine: processor,
    commit: at.commit,
  };
  writeFileSync(path.join(root, 'src/viewer/page/native_ratio.json'), `${JSON.stringify(figure, null, 2)}\n`);
} finally {
  rmSync(folder, {recursive: true});
}
