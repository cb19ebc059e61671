// SPDX-License-Identifier: Apache-2.0
// The report page of a robot whose links are drawn by nothing that a page loads:
// report_sticks.mjs PLAYWRIGHT PAGE HEIGHT
// Its figure of sticks reaches from the ground to HEIGHT metres at least.
import {pathToFileURL} from 'node:url';

import {check, launch} from './report_browser.mjs';

const [playwright, page_file, height] = process.argv.slice(2);
const browser = await launch(playwright);
const page = await browser.newPage();
page.setDefaultTimeout(600e3);  // a busy machine is no failure
page.on('pageerror', (error) => check(false, String(error)));
await page.goto(pathToFileURL(page_file).href);
await page.waitForFunction(() => window.gaitd?.player.frames > 1);
const ends = await page.evaluate(() => {
  const heights = [];
  gaitd.scene.robots[0].pelvis.traverse((part) => {
    if (!part.isMesh) return;
    part.updateWorldMatrix(true, false);
    heights.push(part.matrixWorld.elements[14]);  // z of its middle
  });
  return {count: heights.length, lowest: Math.min(...heights), highest: Math.max(...heights)};
});
check(ends.count >= 12, `${ends.count} parts are drawn`);
check(ends.lowest < 0.1, `the lowest part is drawn ${ends.lowest} m above the ground`);
check(ends.highest > Number(height), `the highest part is drawn ${ends.highest} m above the ground`);
await browser.close();
