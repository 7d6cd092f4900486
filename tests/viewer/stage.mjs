// A browser and a folder of its own for a file of tests; both are gone when the tests have ended.

import {mkdtempSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import path from 'node:path';
import {after, before} from 'node:test';

import {startBrowser} from './browser.mjs';

export const folder = mkdtempSync(path.join(tmpdir(), 'ist-page-'));
/** The browser, once a test runs. */
export let browser;

/** Sets both up before the first test; `prepare` fills the folder. */
export function stage(prepare) {
  before(async () => {
    prepare();
    browser = await startBrowser();
  });
  after(async () => {
    await browser?.close();
    rmSync(folder, {recursive: true});
  });
}
