// Opens pages that the command wrote as people do, from files, and says what they read: open_page.mjs PAGE …

import assert from 'node:assert/strict';

import {answer, closePage, openPage, readout, ready, startBrowser} from '../viewer/browser.mjs';

const browser = await startBrowser();
try {
  for (const file of process.argv.slice(2)) {
    const opened = await openPage(browser, '', {file});
    await ready(opened.page);
    const {line} = await answer(opened.page);
    assert.match(line.touch, /^(yes|no|near)$/);
    console.log(`${file}: ${JSON.stringify(await readout(opened.page))}`);
    await closePage(opened);
  }
} finally {
  await browser.close();
}
