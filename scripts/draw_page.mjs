// Takes the picture of the page that README shows: the built-in jaws where they bite, with the map.
//
//   node scripts/draw_page.mjs docs/pictures/page.png
//
// scripts/viewer.sh makes the page and brings what is needed.

import {fileURLToPath} from 'node:url';

process.env.IST_PAGE ??= fileURLToPath(new URL('../build/viewer/ist.html', import.meta.url));
const {closePage, openPage, startBrowser} = await import('../tests/viewer/browser.mjs');

const [output] = process.argv.slice(2);
if (output === undefined) throw new Error('name the picture: node scripts/draw_page.mjs OUTPUT.png');
const browser = await startBrowser();
try {
  const opened = await openPage(browser, '#pose=1,0,0,0,0,1,0,0,0,0,1,0,0,0,-0.6,1&panel=occlusion&preset=stl',
      {window: {viewport: {width: 1100, height: 640}}});
  await opened.page.waitForFunction(() => document.documentElement.dataset.state === 'ready');
  await opened.page.getByText('The map is of this pose.').waitFor();
  await opened.page.waitForTimeout(1000);  // the last frame
  await opened.page.screenshot({path: output});
  await closePage(opened);
} finally {
  await browser.close();
}
