// SPDX-License-Identifier: Apache-2.0
// The page of a campaign in a headless browser: campaign_page.mjs PLAYWRIGHT PAGE [PICTURE [dark]]
import {pathToFileURL} from 'node:url';

import {check, launch} from './report_browser.mjs';

const [playwright, page_file, picture, scheme] = process.argv.slice(2);
const browser = await launch(playwright);
const context = await browser.newContext(
    {viewport: {width: 1440, height: 1000}, offline: true, colorScheme: scheme === 'dark' ? 'dark' : 'light'});
const page = await context.newPage();
page.setDefaultTimeout(120e3);
const errors = [];
page.on('console', (message) => message.type() === 'error' && errors.push(message.text()));
page.on('pageerror', (error) => errors.push(String(error)));
page.on('request', (request) => /^(file|data):/.test(request.url()) || errors.push(`request of ${request.url()}`));
await page.goto(pathToFileURL(page_file).href);
await page.waitForFunction(() => window.gaitd);
check(!errors.length, errors.join('; '));

const {runs, summary, comparisons} = await page.evaluate(() => gaitd.data);
const shown = () => page.locator('#run h2').innerText();

// The worst run is there from the start, with its doctor and the command of its replay.
check((await shown()).startsWith(`Run ${summary.worst[0].run} `), `shown at first: ${await shown()}`);
const panel = await page.locator('#run').innerText();
for (const part of ['Doctor', 'Replay', summary.worst[0].replay, 'gaitctl report logs/']) {
  check(panel.includes(part), `no '${part}' in: ${panel}`);
}

// Every run that has the figure is a dot, and a click on it shows that run.
const dots = page.locator('#distributions circle.run');
const measured = runs.filter(({figures}) => figures[4] !== null).length;
check(await dots.count() === measured, `${await dots.count()} dots of ${measured} runs`);
for (const place of [0, measured - 1]) {
  const dot = dots.nth(place), run = await dot.getAttribute('data-run');
  await dot.dispatchEvent('click');
  check((await shown()).startsWith(`Run ${run} `), `dot of run ${run} shows ${await shown()}`);
}

// A rate leads to its runs, by the keyboard too, and from there to one of them.
const row = page.locator('#rates table.rates tbody tr').first();
await row.focus();
await page.keyboard.press('Enter');
const listed = page.locator('#run ol.runs li');
check(await listed.count() === summary.cells[0].runs, `${await listed.count()} runs of a combination`);
await listed.first().click();
check(/^Run \d+ /.test(await shown()), `a line of the list shows ${await shown()}`);

// So does a cell of a map; rates are those of the summary.
check(await page.locator('table.map td').count() === 4, 'the map has not four cells');
await page.locator('table.map td').first().click();
check(await listed.count() === 3, `${await listed.count()} runs of a cell`);
for (const cell of summary.cells) {
  const text = await page.locator('#rates').innerText();
  check(text.includes(`${cell.successes}/${cell.runs}`), `no ${cell.successes}/${cell.runs} in ${text}`);
}
check(comparisons.length === 2 && comparisons.every(({pairs}) => pairs === 6), 'pairs of the same seeds');
check(await page.locator('#comparisons figure').count() === 2, 'not every comparison is shown');
// Seeds are counted by the pairs that a figure has, in which neither fell.
const {seeds} = await page.evaluate(() => gaitd.data);
const undecided = comparisons.flatMap(({pairs: all, figures}, place) =>
    figures.filter(({more}) => more > 0).map((one) => ({...one, all, place})));
check(undecided.some(({pairs, all}) => pairs < all), 'no undecided figure has fewer pairs than its comparison');
for (const {figure, more, pairs, place} of undecided) {
  const words = `${Math.ceil(more / (pairs / seeds)).toLocaleString('en')} more seeds`;
  const told = await page.locator('#comparisons figure').nth(place).locator('tbody tr', {hasText: figure}).innerText();
  check(told.includes(words), `${figure} has ${pairs} pairs, but no '${words}' in ${told}`);
}
check(await page.locator('#polar img').evaluate((image) => image.naturalWidth > 0), 'no polar plot');

// Nothing is wider than the window, also of a phone.
for (const width of [1440, 420]) {
  await page.setViewportSize({width, height: 1000});
  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  check(wide <= width, `${wide} px wide in a window of ${width}`);
}
check(!errors.length, errors.join('; '));
if (picture) {
  await page.setViewportSize({width: 1440, height: 1000});
  await page.evaluate((run) => gaitd.showRun(run), summary.worst[0].run);
  await page.screenshot({path: picture, fullPage: process.argv.includes('whole')});
}
await browser.close();
