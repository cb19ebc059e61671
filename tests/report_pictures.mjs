// SPDX-License-Identifier: Apache-2.0
// The report page draws the same with WebGL and without: report_pictures.mjs PLAYWRIGHT PAGE
// Exit code 1 with the reason if it does not.
import {pathToFileURL} from 'node:url';

import {check, launch} from './report_browser.mjs';

const [playwright, page_file] = process.argv.slice(2);

const browser = await launch(playwright);

async function open(renderer) {
  const page = await browser.newPage({viewport: {width: 1280, height: 800}});
  page.setDefaultTimeout(600e3);  // a busy machine is no failure
  await page.goto(`${pathToFileURL(page_file).href}#renderer=${renderer}`);
  await page.waitForFunction(() => window.gaitd?.player.frames > 1);
  const by = await page.evaluate(() => gaitd.scene.renderer.isWebGLRenderer ? 'webgl' : 'software');
  check(by === renderer, `asked for ${renderer}, ${by} draws`);
  return page;
}

// A picture of the scene at a share of the log, as a URL with all of it.
const draw = (page, share) => page.evaluate((share) => {
  gaitd.scene.show(gaitd.log.time[Math.floor(share * gaitd.log.rows)]);
  return gaitd.scene.renderer.domElement.toDataURL();
}, share);

// Of two pictures, the shares of pixels of the first that are darker than sky and ground, and of
// pixels that differ.
const compare = (page, urls) => page.evaluate(async (urls) => {
  const [one, other] = await Promise.all(urls.map(async (url) => {
    const image = new Image();
    image.src = url;
    await image.decode();
    const canvas = new OffscreenCanvas(image.width, image.height), context = canvas.getContext('2d');
    context.drawImage(image, 0, 0);
    return context.getImageData(0, 0, image.width, image.height).data;
  }));
  let robot = 0, differ = one.length === other.length ? 0 : one.length;
  for (let at = 0; at < one.length; at += 4) {
    if (one[at] < 160) ++robot;
    const differs = [0, 1, 2].some((i) => Math.abs(one[at + i] - other[at + i]) > 40);
    if (differs) ++differ;
  }
  return {robot: 4 * robot / one.length, differ: 4 * differ / one.length};
}, urls);

const [webgl, software] = [await open('webgl'), await open('software')];
for (const share of [0.1, 0.5, 0.9]) {
  const pictures = [await draw(software, share), await draw(webgl, share)];
  const {robot, differ} = await compare(software, pictures);
  console.log(`at ${share} of the log ${(100 * robot).toFixed(1)} % of the picture are robot, ` +
              `${(100 * differ).toFixed(2)} % differ with and without WebGL`);
  check(robot > 0.01, 'no robot is drawn');
  check(differ < 0.008, 'with and without WebGL the pictures differ');
}
await browser.close();
