// SPDX-License-Identifier: Apache-2.0
// The report page of two logs, the second with a push: report_two.mjs PLAYWRIGHT PAGE [PICTURE]
// Exit code 1 with the reason if anything is not as it should be.
import {pathToFileURL} from 'node:url';

import {check, launch} from './report_browser.mjs';

const [playwright, page_file, picture] = process.argv.slice(2);

const browser = await launch(playwright);

async function open(colorScheme) {
  const page = await browser.newPage({viewport: {width: 1280, height: 800}, colorScheme});
  page.setDefaultTimeout(600e3);  // a busy machine is no failure
  page.on('pageerror', (error) => check(false, String(error)));
  await page.goto(pathToFileURL(page_file).href);
  await page.waitForFunction(() => window.gaitd?.player.frames > 1);
  for (const box of await page.locator('#plots > div').all()) {
    await box.scrollIntoViewIfNeeded();
    await box.locator('.u-over').waitFor();
  }
  return page;
}

const page = await open('light');

// Both logs in every plot, each line in a colour of its own.
const plots = await page.evaluate(() => gaitd.plots.map(({id, plot}) => ({id, lines: plot.series.slice(1)
    .filter(({scale}) => scale !== 'states')
    .map(({label, stroke}, i) => ({label, color: stroke(plot, i + 1)}))})));
const names = await page.evaluate(() => gaitd.log.all.map(({name}) => name));
check(names.length === 2 && names[0] !== names[1], `the page holds the logs ${names}`);
for (const {id, lines} of plots) {
  for (const name of names) {
    check(lines.some(({label}) => label.endsWith(`, ${name}`)), `${id} has no line of ${name}`);
  }
  for (const what of ['label', 'color']) {
    const all = new Set(lines.map((line) => line[what]));
    check(all.size === lines.length, `${id}: a ${what} is there twice: ${lines.map((line) => line[what])}`);
  }
}

// The ghost is where the second robot was; the arrow is there while it is pushed, and no longer.
const pushed = await page.evaluate(async () => {
  const [, other] = gaitd.log.all, [push] = other.pushes, [, ghost] = gaitd.scene.robots;
  const at = async (time) => {
    gaitd.player.go(time);
    const frames = gaitd.player.frames;
    while (gaitd.player.frames < frames + 2) await new Promise(requestAnimationFrame);
    return {ghost: ghost.pelvis.position.toArray(), logged: other.point('pelvis', other.row(time)),
            arrows: gaitd.scene.arrows.map(({group}) => group.visible)};
  };
  return {push, before: await at(push.time - 0.5), during: await at(push.time + 0.1), after: await at(push.time + 1.5)};
});
check(pushed.push.push === 'pelvis' && pushed.push.force[1] === 150, `the push is ${JSON.stringify(pushed.push)}`);
for (const {ghost, logged} of [pushed.before, pushed.during]) {
  const distance = Math.hypot(...ghost.map((value, i) => value - logged[i]));
  check(distance < 1e-6, `the ghost is drawn ${distance} m from where it was`);
}
check(!pushed.before.arrows[1] && pushed.during.arrows[1] && !pushed.after.arrows[1],
      `arrows before, during and after the push: ${JSON.stringify(pushed)}`);
check(!pushed.during.arrows[0], 'the robot that was not pushed has an arrow');

// Keys.
const state = () => page.evaluate(() => ({playing: gaitd.player.playing, time: gaitd.player.time,
    keys: document.getElementById('keys').open}));
await page.evaluate(() => { gaitd.player.go(1); document.activeElement?.blur(); });
await page.keyboard.press('Space');
check((await state()).playing, 'space does not play');
await page.keyboard.press('Space');
check(!(await state()).playing, 'space does not pause');
const {time} = await state();
await page.keyboard.press('Shift+ArrowRight');
check(Math.abs((await state()).time - time - 1) < 1e-6, 'Shift and the right arrow do not go on by 1 s');
await page.keyboard.press('Home');
check((await state()).time === 0 || (await state()).time < 0.01, 'Home does not go to the begin');
await page.locator('#play').focus();
await page.keyboard.press('Space');
check((await state()).playing, 'space on the button that has the focus presses it twice');
await page.keyboard.press('Space');
await page.keyboard.press('?');
check((await state()).keys, '? does not show the keys');
const shown = await page.locator('#keys').innerText();
for (const key of ['Space', 'Home', 'End', '?']) check(shown.includes(key), `the list of keys has no ${key}`);
if (picture) await page.screenshot({path: `${picture}-keys.png`});
await page.keyboard.press('Escape');
check(!(await state()).keys, 'Escape does not hide the keys');
if (picture) {
  await page.evaluate((time) => gaitd.player.go(time), pushed.push.time + 0.1);
  await page.locator('#plots > div').first().scrollIntoViewIfNeeded();
  await page.waitForTimeout(500);
  await page.screenshot({path: `${picture}-light.png`});
}

// Dark where the browser is.
const brightness = (one) => one.evaluate(() => {
  const of = (color) => color.match(/\d+/g).slice(0, 3).reduce((sum, part) => sum + Number(part), 0) / 765;
  const style = getComputedStyle(document.body);
  return {paper: of(style.backgroundColor), ink: of(style.color), sky: gaitd.scene.scene.background.getHex()};
});
const dark = await open('dark');
const [light_look, dark_look] = [await brightness(page), await brightness(dark)];
check(light_look.paper > 0.8 && light_look.ink < 0.3, `light: ${JSON.stringify(light_look)}`);
check(dark_look.paper < 0.2 && dark_look.ink > 0.7, `dark: ${JSON.stringify(dark_look)}`);
check(dark_look.sky < light_look.sky, 'the sky of the scene stays light');
if (picture) {
  await dark.evaluate((time) => gaitd.player.go(time), pushed.push.time + 0.1);
  await dark.locator('#plots > div').nth(1).scrollIntoViewIfNeeded();
  await dark.waitForTimeout(500);
  await dark.screenshot({path: `${picture}-dark.png`});
}
await browser.close();
console.log(`${names.join(' and ')}: ${plots.length} plots of both, ghost, push, keys, dark`);
