// Takes README's picture of the page, the bite of the built-in jaws with the map, or the pictures of the
// canvas. tests/viewer/page_picture_test.mjs compares both.
//
//   node scripts/draw_page.mjs docs/pictures/page.png
//   node scripts/draw_page.mjs tests/viewer/pictures
//
// scripts/viewer.sh makes the page and installs its packages.

import {writeFileSync} from 'node:fs';
import path from 'node:path';
import {fileURLToPath} from 'node:url';

process.env.IST_PAGE ??= fileURLToPath(new URL('../build/viewer/ist.html', import.meta.url));
const {closePage, startBrowser} = await import('../tests/viewer/browser.mjs');
const {openView, pageDrawn, pictureOf, views} = await import('../tests/viewer/pictures.mjs');

const [output] = process.argv.slice(2);
if (output === undefined) throw new Error('name the picture, or the folder of all that tests compare: node scripts/draw_page.mjs OUTPUT');

const browser = await startBrowser();
try {
  if (output.endsWith('.png')) {
    const {opened, picture} = await pageDrawn(browser);
    writeFileSync(output, picture);
    await closePage(opened);
  } else {
    for (const view of views) {
      const opened = await openView(browser, view);
      writeFileSync(path.join(output, `${view.name}.png`), await pictureOf(opened.page));
      await closePage(opened);
    }
  }
} finally {
  await browser.close();
}
