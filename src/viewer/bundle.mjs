// Makes the page: one HTML file with its modules, its style, the Worker and the engine in it.
//
//   node bundle.mjs --engine DIR --output FILE --bundled FILE
//
// DIR holds engine.js and engine.wasm. The second file gets the names of the packages whose code is in the page.
import {createHash} from 'node:crypto';
import {mkdirSync, readFileSync, writeFileSync} from 'node:fs';
import {dirname, join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {parseArgs} from 'node:util';
import {gzipSync} from 'node:zlib';

import {build, transform} from 'esbuild';

// What a mail takes without complaint, with room for the data of two jaws.
const mostBytes = 2_000_000;
const here = dirname(fileURLToPath(import.meta.url));
const page = join(here, 'page');
const target = ['chrome100', 'firefox113', 'safari16.4'];

const {values} = parseArgs({options: {engine: {type: 'string'}, output: {type: 'string'}, bundled: {type: 'string'}}});
if (!values.engine || !values.output) {
  console.error('bundle: give --engine DIR, which holds engine.js and engine.wasm, and --output FILE');
  process.exit(2);
}

const packed = (bytes) => gzipSync(bytes, {level: 9}).toString('base64');
const hash = (text) => `'sha256-${createHash('sha256').update(text, 'utf8').digest('base64')}'`;
// An element's text ends at the first of these, whatever is meant by them.
const safe = (script) => script.replaceAll(/<\/(script|style)/gi, '<\\/$1').replaceAll('<!--', '<\\!--');

async function pageScript() {
  const {outputFiles, metafile} = await build({
    entryPoints: [join(page, 'main.js')],
    bundle: true,
    write: false,
    minify: true,
    format: 'iife',
    target,
    legalComments: 'none',
    outdir: here,
    logLevel: 'warning',
    metafile: true,
  });
  const names = Object.keys(metafile.inputs).map((file) => file.match(/.*node_modules\/((?:@[^/]+\/)?[^/]+)/)?.[1]);
  if (values.bundled) writeFileSync(values.bundled, `${JSON.stringify([...new Set(names.filter(Boolean))].sort())}\n`);
  return safe(outputFiles[0].text);
}

async function workerScript(engine) {
  const texts = [readFileSync(join(engine, 'engine.js'), 'utf8'), readFileSync(join(page, 'worker.js'), 'utf8')];
  // The engine's factory is a global of this script, as it is of a classic one.
  const classic = texts[0].replace(/^export default createEngine;?\s*$/m, '').replaceAll('import.meta.url', 'self.location.href');
  return (await transform([classic, texts[1]].join('\n'), {minifyWhitespace: true, minifySyntax: true, target, legalComments: 'none'}))
    .code;
}

async function styleSheet() {
  const {code} = await transform(readFileSync(join(page, 'style.css'), 'utf8'), {loader: 'css', minify: true, target});
  return code.trim();
}

function notices() {
  const licence = (file) => readFileSync(file, 'utf8').trim();
  const text = [
    'IST',
    licence(join(here, '../../LICENSE')),
    'three.js',
    licence(join(here, 'node_modules/three/LICENSE')),
    licence(join(here, 'notices.txt')),
  ].join('\n\n');
  return text.replaceAll('<', '(').replaceAll('>', ')');
}

const script = await pageScript();
const style = await styleSheet();
const parts = {
  SCRIPT_HASH: hash(script),
  STYLE_HASH: hash(style),
  STYLE: style,
  NOTICES: notices(),
  SCRIPT: script,
  WORKER: packed(await workerScript(values.engine)),
  ENGINE: packed(readFileSync(join(values.engine, 'engine.wasm'))),
};
// Each part once, in one pass: a part's own text is never searched for the name of another.
const html = readFileSync(join(page, 'index.html'), 'utf8').replaceAll(/@([A-Z_]+)@/g, (whole, name) => parts[name] ?? whole);
const bytes = Buffer.byteLength(html);
if (bytes >= mostBytes) {
  console.error(`bundle: the page has ${bytes} bytes, and ${mostBytes} are the most: make the engine or the page smaller`);
  process.exit(1);
}
mkdirSync(dirname(values.output), {recursive: true});
writeFileSync(values.output, html);
console.log(`bundle: ${values.output} has ${(bytes / 1e6).toFixed(2)} MB`);
