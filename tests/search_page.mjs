// SPDX-License-Identifier: Apache-2.0
// The page of a search in a headless browser: search_page.mjs PLAYWRIGHT PAGE
import {pathToFileURL} from 'node:url';

import {check, launch} from './report_browser.mjs';

const [playwright, page_file] = process.argv.slice(2);
const browser = await launch(playwright);
const page = await (await browser.newContext({viewport: {width: 1440, height: 1000}, offline: true})).newPage();
const errors = [];
page.on('console', (message) => message.type() === 'error' && errors.push(message.text()));
page.on('pageerror', (error) => errors.push(String(error)));
await page.goto(pathToFileURL(page_file).href);
await page.waitForFunction(() => window.gaitd);

// Nothing fell: each limit is at most the last value, with an interval that goes on to the edge.
const {summary} = await page.evaluate(() => gaitd.data);
const rows = page.locator('#rates table.rates tbody tr');
check(await rows.count() === summary.cells.length, `${await rows.count()} rows`);
check((await rows.first().innerText()).includes('≤ 0.5'), await rows.first().innerText());
check(await rows.first().locator('line.interval').count() === 1, 'no interval');
check(await page.locator('table.map').count() === 1, 'no map of limits');
check((await page.locator('table.map td').first().innerText()).includes('≤ 0.5'), 'no limit in the map');
await page.locator('table.map td').first().click();
check(await page.locator('#run ol.runs li').count() === summary.cells[0].runs, 'not the runs of a cell');
check(!errors.length, errors.join('; '));
await browser.close();
