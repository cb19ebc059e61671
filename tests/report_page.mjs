// SPDX-License-Identifier: Apache-2.0
// The report page in a headless browser: report_page.mjs PLAYWRIGHT PAGE [PICTURE]
// Prints what it measured; exit code 1 with the reason if anything is not as it should be.
import {pathToFileURL} from 'node:url';

import {check, launch} from './report_browser.mjs';

const [playwright, page_file, picture] = process.argv.slice(2);

const kLongestOpening = 3000;  // ms
const measured = !process.env.GAITD_NO_RATE;  // how many frames a second
const kFrames = 55;  // 1/s: 60 less what a busy machine takes

const browser = await launch(playwright);
const context = await browser.newContext({viewport: {width: 1280, height: 800}, offline: true});
const page = await context.newPage();
page.setDefaultTimeout(600e3);  // a busy machine is no failure
const errors = [];
page.on('console', (message) => message.type() === 'error' && errors.push(message.text()));
page.on('pageerror', (error) => errors.push(String(error)));
page.on('request', (request) => /^(file|data|blob):/.test(request.url()) ||
    errors.push(`request of ${request.url()}`));

const session = await context.newCDPSession(page);
await session.send('Performance.enable', {timeDomain: 'threadTicks'});
const processorTime = async () =>
    (await session.send('Performance.getMetrics')).metrics.find(({name}) => name === 'TaskDuration').value;

// It opens within 3 s, on a busy machine at least once.
let opened;
for (let tries = 0; tries < 10 && !(opened < kLongestOpening); ++tries) {
  const before = await processorTime(), began = Date.now();
  await page.goto(pathToFileURL(page_file).href);
  await page.waitForFunction(() => window.gaitd?.player.frames > 1);
  opened = Date.now() - began;
  const built = await page.evaluate(() => gaitd.built);
  const length = await page.evaluate(() => gaitd.log.time[gaitd.log.rows - 1]);
  const seconds = await processorTime() - before;
  console.log(`a log of ${length.toFixed(0)} s opened in ${opened} ms: ${seconds.toFixed(2)} s of ` +
              `processor time, parsed and built in ${built.toFixed(0)} ms`);
}
check(opened < kLongestOpening, `the page took ${opened} ms to open`);
check(!errors.length, errors.join('; '));

// The drawn pelvis is where the log says, at any time.
const times = await page.evaluate(() => [gaitd.log.time[0], gaitd.log.time[gaitd.log.rows - 1]]);
const places = new Set();
for (const share of [0.1, 0.5, 0.9]) {
  const time = times[0] + share * (times[1] - times[0]);
  const {drawn, logged, clock} = await page.evaluate(async (time) => {
    const slider = document.getElementById('slider');
    slider.value = time;
    slider.dispatchEvent(new Event('input'));
    const frames = gaitd.player.frames;
    while (gaitd.player.frames < frames + 2) await new Promise(requestAnimationFrame);
    const row = gaitd.log.row(gaitd.player.time);
    return {drawn: gaitd.scene.pelvis.position.toArray(), logged: gaitd.log.point('pelvis', row),
            clock: document.getElementById('clock').value};
  }, time);
  const distance = Math.hypot(...drawn.map((value, i) => value - logged[i]));
  check(distance < 1e-6, `at ${time} s the pelvis is drawn ${distance} m from where it was`);
  check(Math.abs(parseFloat(clock) - time) < 0.00501, `the clock shows '${clock}' at ${time} s`);
  places.add(drawn.map((value) => value.toFixed(3)).join());
}
check(places.size === 3, 'the robot does not move');

// A joint of the drawn robot has the logged angle.
const joint = await page.evaluate(() => {
  const moved = gaitd.scene.joints.find(({joint}) => /kny|knee/.test(joint.urdfName)) ??
      gaitd.scene.joints[0];
  return {drawn: moved.joint.angle, logged: moved.column[gaitd.log.row(gaitd.player.time)]};
});
check(Math.abs(joint.drawn - joint.logged) < 1e-5, `a joint is drawn at ${joint.drawn}, not ${joint.logged}`);

// A click into a plot takes the replay there, and the slider with it.
const plot = page.locator('#plot-icp-x .u-over');
await page.locator('#plot-icp-x').scrollIntoViewIfNeeded();
const box = await plot.boundingBox();
await page.mouse.click(box.x + 0.25 * box.width, box.y + 0.5 * box.height);
const went = await page.evaluate(() => ({
  player: gaitd.player.time, slider: Number(document.getElementById('slider').value),
  clicked: gaitd.plots.find(({id}) => id === 'icp-x').plot.posToVal(
      0.25 * document.querySelector('#plot-icp-x .u-over').clientWidth, 'x')}));
check(Math.abs(went.player - went.clicked) < 0.05, `a click at ${went.clicked} s went to ${went.player} s`);
check(Math.abs(went.player - went.slider) < 0.01, `slider at ${went.slider} s, replay at ${went.player} s`);

// The slider takes the lines in the plots with it.
const off = await page.evaluate(async () => {
  const slider = document.getElementById('slider');
  slider.value = gaitd.log.time[Math.floor(0.7 * gaitd.log.rows)];
  slider.dispatchEvent(new Event('input'));
  const frames = gaitd.player.frames;
  while (gaitd.player.frames < frames + 2) await new Promise(requestAnimationFrame);
  return gaitd.plots.filter(({plot}) => plot.placeTime).map(({plot}) =>
      plot.over.querySelector('.now').getBoundingClientRect().left -
      plot.over.getBoundingClientRect().left - plot.valToPos(Number(slider.value), 'x'));
});
check(off.length > 0 && off.every((pixels) => Math.abs(pixels) < 1),
      `the slider left the lines of the plots behind: ${off} px`);

// It plays, no faster than time passes.
const [before, after] = await page.evaluate(async () => {
  const state = () => ({time: gaitd.player.time, frames: gaitd.player.frames, now: performance.now()});
  gaitd.player.go(gaitd.log.time[0]);
  document.getElementById('speed').value = '0.1';  // far from the end of the shortest log
  const start = state();
  document.getElementById('play').click();
  while (gaitd.player.frames < start.frames + 5 || performance.now() < start.now + 1000) {
    await new Promise(requestAnimationFrame);
  }
  document.getElementById('play').click();
  return [start, state()];
});
const passed = (after.now - before.now) / 1000;
check(after.time > before.time && after.time - before.time < 0.1 * passed + 0.1,
      `${after.time - before.time} s were played in ${passed} s`);

// Sixty frames each second: for the page itself in each second, with all that a browser does in the
// best of them, for a machine may be busy.
let best = 0;
for (let tries = 0; measured && tries < 120 && best < kFrames; ++tries) {
  const spent = await processorTime();
  const {frames, seconds} = await page.evaluate(async () => {
    const {player} = gaitd, play = document.getElementById('play');
    document.getElementById('speed').value = '1';
    player.go(gaitd.log.time[0]);
    play.click();
    await new Promise(requestAnimationFrame);
    const frames = player.frames, began = performance.now();
    while (performance.now() < began + 1000) await new Promise(requestAnimationFrame);
    play.click();
    return {frames: player.frames - frames, seconds: (performance.now() - began) / 1000};
  });
  best = Math.max(best, frames / seconds);
  const each = 1000 * (await processorTime() - spent) / frames;
  console.log(`${(frames / seconds).toFixed(1)} frames/s, ${each.toFixed(1)} ms of processor time each`);
  check(each < 1000 / 60, `a frame takes ${each.toFixed(1)} ms of processor time`);
}
check(!measured || best >= kFrames, `it plays at ${best.toFixed(1)} frames/s at best`);

// Plots are made as they come into view.
for (const box of await page.locator('#plots > div').all()) {
  await box.scrollIntoViewIfNeeded();
  await box.locator('.u-over').waitFor();
}
const plots = await page.evaluate(() => gaitd.plots.map(({id}) => id));
console.log(`plots: ${plots.join(' ')}`);
check(plots.length >= 8, `only ${plots.length} plots`);
const empty = await page.evaluate(() => gaitd.plots.filter(({plot: {scales: {x, y}}}) =>
    !(x.max > x.min && y.max > y.min)).map(({id}) => id));
check(!empty.length, `nothing on the plots ${empty.join(' ')}`);
check(!errors.length, errors.join('; '));
if (picture) {
  await page.locator('#plots > div').first().scrollIntoViewIfNeeded();
  await page.screenshot({path: picture});
}
await browser.close();
