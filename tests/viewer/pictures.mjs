// Pictures of the canvas alone, of a fixed size, and how far two of them differ. The kept ones lie in
// pictures/; scripts/draw_page.mjs makes them anew.

import {closedBy, lastPicture, openPage, ready} from './browser.mjs';

const canvas = {width: 400, height: 300};
/** Of the picture of the whole page. */
export const wholePage = {width: 1100, height: 640};
// The middle of the box of the built-in lower jaw: the tool's origin in a recording.
const middle = [0, -7.72038269, 43.5451901];
/** Of the pixels, how many may be off, and by how much of 255 a pixel that is not may differ. */
export const mostOff = 0.01,
  mostChange = 16;

/** A hand that holds the lower jaw half a millimetre below the upper one, and draws it upwards. */
function recordingOfJaws() {
  const tool = middle.map((value) => value * 1e-3);
  const scene =
    'unit = "mm"\n[fixed]\nshape = "upper jaw"\nvoxel_size = 1\n[held]\nshape = "lower jaw"\nvoxel_size = 1\n' +
    'translation = [0, 0, -0.5]\n[effects.contact]\n';
  const row = (dz) => [tool[0], tool[1], tool[2] + dz - 0.5e-3, 1, 0, 0, 0, 1, 0, 0, 0, 1];
  const header = {recording: 3, ist: '1.2.3', commit: '', dt: 0.001, unit: 0.001, bodies: [{name: 'fixed'}, {name: 'held'}], scene};
  const ticks = [0, 1].map((tick) => ({
    tick,
    dt: 0.001,
    device: row(1e-3),
    tool: row(0),
    wrench: [0, 0, -2, 0, 0, 0],
    contacts: 9,
    steps: 0,
    points: [],
    held: false,
    fault: false,
    late_microseconds: 0,
    microseconds: 40,
  }));
  return [header, ...ticks].map((line) => `${JSON.stringify(line)}\n`).join('');
}

async function comeNearer(page, times) {
  await page.locator('canvas').focus();
  for (let i = 0; i < times; i++) await page.keyboard.press('+');
}

export const views = [
  {name: 'bodies', fragment: '#voxel=2&panel=pose'},
  {
    name: 'contacts',
    fragment: `#voxel=0.8&panel=contacts&pose=${closedBy(-0.2)}`,
    async show(page) {
      await page.getByRole('button', {name: 'Look at contact 1', exact: true}).click();
      await comeNearer(page, 3);
    },
  },
  {name: 'tree', fragment: `#voxel=2&panel=tree&pose=${closedBy(-0.2)}`, show: (page) => page.getByText(/nodes/).first().waitFor()},
  {
    name: 'map',
    fragment: `#voxel=2&panel=occlusion&preset=stl&pose=${closedBy(-0.2)}`,
    async show(page) {
      await page.getByText('The map is of this pose.').waitFor();
      await comeNearer(page, 3);
    },
  },
  {
    name: 'recording',
    fragment: '#voxel=2&panel=recording',
    async show(page) {
      await page
        .getByLabel('Open a recording')
        .setInputFiles({name: 'run.jsonl', mimeType: 'text/plain', buffer: Buffer.from(recordingOfJaws())});
      await page.getByText('2 ticks of').waitFor();
    },
  },
];

/** Opens the page with a canvas of the fixed size, as a view has it. */
export async function openView(browser, {fragment, show, file}, theme = 'light') {
  const opened = await openPage(browser, `${fragment}&theme=${theme}`, {
    file,
    before: () =>
      document.addEventListener('DOMContentLoaded', () => {
        Object.assign(document.getElementById('surface').style, {inset: 'auto', width: '400px', height: '300px'});
      }),
  });
  await ready(opened.page);
  await show?.(opened.page);
  await ready(opened.page);
  return opened;
}

/** The whole page as README shows it: the built-in jaws where they bite, with the map. */
export async function pageDrawn(browser) {
  const opened = await openPage(browser, `#pose=${closedBy(-0.6)}&panel=occlusion&preset=stl&theme=light`, {window: {viewport: wholePage}});
  const {page} = opened;
  await ready(page);
  await page.getByText('The map is of this pose.').waitFor();
  await ready(page);
  return {opened, picture: await lastPicture(() => page.screenshot())};
}

/** The canvas as it is drawn now: a PNG. */
export async function pictureOf(page) {
  const text = await page.evaluate(async () => {
    const reader = new FileReader();
    reader.readAsDataURL(await window.ist.picture());
    await new Promise((resolve) => {
      reader.onload = resolve;
    });
    return reader.result.split(',')[1];
  });
  return Buffer.from(text, 'base64');
}

/**
 * Compares two PNGs, which the browser reads, of a size.
 * @returns {Promise<number>} the part of their pixels that differ by more than mostChange; 1 where a size is another
 */
export function partOff(page, one, other, {width, height} = canvas) {
  return page.evaluate(
    async ({texts, size, mostChange}) => {
      const [one, other] = await Promise.all(
        texts.map(async (text) => {
          const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
          const image = await createImageBitmap(new Blob([bytes], {type: 'image/png'}), {colorSpaceConversion: 'none'});
          const canvas = new OffscreenCanvas(image.width, image.height).getContext('2d');
          canvas.drawImage(image, 0, 0);
          return canvas.getImageData(0, 0, image.width, image.height);
        }),
      );
      if ([one, other].some(({width, height}) => width !== size[0] || height !== size[1])) return 1;
      let off = 0;
      for (let at = 0; at < one.data.length; at += 4) {
        if ([0, 1, 2].some((colour) => Math.abs(one.data[at + colour] - other.data[at + colour]) > mostChange)) off += 1;
      }
      return off / (one.data.length / 4);
    },
    {texts: [one, other].map((png) => png.toString('base64')), size: [width, height], mostChange},
  );
}
