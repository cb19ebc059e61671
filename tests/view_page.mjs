// SPDX-License-Identifier: Apache-2.0
// The live page in a headless browser, with a real gaitd and a real `gaitctl view`:
//   view_page.mjs PLAYWRIGHT ADDRESSES SOCKET PID [PICTURE]
// ADDRESSES: what `gaitctl --json view` printed; SOCKET and PID: of gaitd, which is killed and started again.
// Prints what it measured; exit code 1 with the reason if anything is not as it should be.
import {spawn} from 'node:child_process';
import {readFileSync, writeFileSync} from 'node:fs';
import {connect} from 'node:net';

import {check, launch} from './report_browser.mjs';

const [playwright, addresses, socket, pid, picture] = process.argv.slice(2);
const pages = JSON.parse(readFileSync(addresses, 'utf8'));

const kLatency = 0.15;   // s that the drawn pelvis may be behind the truth, in the median
const kApart = 0.05;     // m, of the drawn pelvis (an estimate) from the truth of the same tick
const kPatience = 60e3;  // ms: a busy machine is no failure

const now = () => performance.timeOrigin + performance.now();
const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
const median = (list) => list.toSorted((a, b) => a - b)[Math.floor(list.length / 2)];

async function until(what, holds, patience = kPatience) {
  for (const end = Date.now() + patience; Date.now() < end;) {
    if (await holds()) return;
    await sleep(50);
  }
  check(false, `${what}: not within ${patience / 1000} s`);
}

// ---- The truth, past `gaitctl view`.
class Truth {
  constructor() {
    this.rows = [];  // {wall, time, tick, pelvis}
    this.events = [];
  }

  async open() {
    let rest = '';
    this.socket = connect(socket);
    await new Promise((resolve, reject) => this.socket.once('connect', resolve).once('error', reject));
    this.socket.on('error', () => {});
    this.socket.on('data', (data) => {
      const lines = (rest + data).split('\n');
      rest = lines.pop();
      for (const line of lines) this.take(JSON.parse(line));
    });
    this.socket.write(JSON.stringify({jsonrpc: '2.0', id: 1, method: 'telemetry.subscribe', params: {
      signals: ['truth/pelvis/x', 'truth/pelvis/y', 'truth/pelvis/z'], rate: 200, events: true}}) + '\n');
    await until('the truth', () => this.rows.length > 10);
  }

  take({id, error, method, params}) {
    if (id) check(!error, JSON.stringify(error));
    if (method === 'telemetry.event') this.events.push(params);
    if (method !== 'telemetry.frame') return;
    this.rows.push({wall: now(), time: params.time, tick: params.tick, pelvis: params.values});
    if (this.rows.length > 20000) this.rows.splice(0, 10000);
  }

  get newest() { return this.rows.at(-1); }

  // The newest of those that had come at `wall`; the nearest to `time`.
  at(wall) { return this.rows.findLast((row) => row.wall <= wall); }
  of(time) {
    const i = this.rows.findIndex((row) => row.time >= time);
    return this.rows[i < 0 ? this.rows.length - 1 : i];
  }
}
const truth = new Truth();
await truth.open();

// ---- The page.
const browser = await launch(playwright);
const errors = [];

async function open(address, options = {}) {
  const context = await browser.newContext({viewport: {width: 1400, height: 900}, ...options});
  const page = await context.newPage();
  page.setDefaultTimeout(kPatience);
  // That the server is away is what a part of this test is about.
  page.on('console', (message) => message.type() === 'error' &&
      !/WebSocket|ERR_CONNECTION_REFUSED|Failed to load/.test(message.text()) && errors.push(message.text()));
  page.on('pageerror', (error) => errors.push(String(error)));
  page.on('request', (request) => request.url().startsWith(new URL(address).origin) ||
      /^(data|blob):/.test(request.url()) || errors.push(`request of ${request.url()}`));
  await page.goto(address.replace('#', '#renderer=software&'));
  await becomes(page, () => window.gaitd?.frames > 5);
  return page;
}

// `holds` in the page; playwright's own way to wait evaluates text there, which the page forbids.
const becomes = (page, holds) => until(`never: ${holds}`, () => page.evaluate(holds));
const shows = (page, selector, pattern) =>
    until(`no ${pattern} in ${selector}`, async () => pattern.test(await page.locator(selector).innerText()));
const state = (page, name) => shows(page, '#state', new RegExp(`^${name}$`, 'i'));

const page = await open(pages.administer);
check(!page.url().includes(pages.administer.split('=')[1]), 'the token stays in the address');
await state(page, 'standing');

// ---- It walks, and what is drawn follows the truth.
await page.locator('#walk-straight').click();
await page.locator('#steps').fill('8');
await page.locator('#length').fill('0.3');
const start = truth.newest.pelvis[0];
await page.locator('#walk').click();
await until('the robot walks', () => truth.newest.pelvis[0] > start + 0.15);
const drawn = await page.evaluate(() => new Promise((resolve) => {
  const rows = [], end = performance.now() + 3000;
  const frame = () => {
    const {time, tick, pelvis} = gaitd.drawn;
    rows.push({wall: performance.timeOrigin + performance.now(), time, tick, pelvis});
    if (performance.now() < end) requestAnimationFrame(frame);
    else resolve(rows);
  };
  requestAnimationFrame(frame);
}));
check(new Set(drawn.map(({tick}) => tick)).size > 20, `${drawn.length} frames, of one and the same tick`);
const behind = drawn.map(({wall, time}) => truth.at(wall).time - time);
const apart = drawn.map(({time, pelvis}) => Math.hypot(...truth.of(time).pelvis.map((value, i) => value - pelvis[i])));
const way = drawn.at(-1).pelvis[0] - drawn[0].pelvis[0];
const wayOfTruth = truth.of(drawn.at(-1).time).pelvis[0] - truth.of(drawn[0].time).pelvis[0];
console.log(`${drawn.length} frames in 3 s, behind the truth by ${(1000 * median(behind)).toFixed(0)} ms in the median, ` +
            `at most ${(1000 * Math.max(...behind)).toFixed(0)}; drawn ${(1000 * median(apart)).toFixed(1)} mm from it`);
check(median(behind) <= kLatency, 'the drawn robot is late');
check(median(apart) < kApart, 'the robot is drawn elsewhere');
check(wayOfTruth > 0.1 && Math.abs(way - wayOfTruth) < kApart, `it went ${wayOfTruth} m and was drawn for ${way} m`);
if (picture) await takePictures(picture);

// ---- Space ends the walk.
await page.keyboard.press('Space');
await state(page, 'standing');

// ---- The stick walks it, and lets go of it.
const stick = await page.locator('#stick').boundingBox();
const [x, y] = [stick.x + stick.width / 2, stick.y + stick.height / 2];
const before = truth.newest.pelvis[0];
await page.mouse.move(x, y);
await page.mouse.down();
await page.mouse.move(x, stick.y + 4, {steps: 4});
await until('the stick walks it', () => truth.newest.pelvis[0] > before + 0.4);
check(await page.locator('#stick.held').count() === 1, 'the stick is not held');
await page.mouse.up();
await state(page, 'standing');
const stood = truth.newest.pelvis[0];
await sleep(1500);
check(Math.abs(truth.newest.pelvis[0] - stood) < 0.05, 'it walks on though the stick was let go');

// ---- A click on the ground sends it there.
const scene = await page.locator('#scene').boundingBox();
const goal = [truth.newest.pelvis[0] + 0.5, truth.newest.pelvis[1] - 0.1];
const onScreen = await page.evaluate(([gx, gy]) => {
  const {scene} = gaitd, level = gaitd.live.newest('foot/left/z');
  return scene.camera.position.clone().set(gx, gy, level).project(scene.camera).toArray();
}, goal);
await page.locator('#goto').click();
await page.mouse.click(scene.x + (onScreen[0] + 1) / 2 * scene.width, scene.y + (1 - onScreen[1]) / 2 * scene.height);
await until('it does not go where one clicks', () =>
    Math.hypot(...truth.newest.pelvis.slice(0, 2).map((value, i) => value - goal[i])) < 0.08);
await state(page, 'standing');

// ---- Who drags a link pushes it.
truth.events = [];
const chest = await page.evaluate(() => {
  const {scene} = gaitd, at = scene.camera.position.clone();
  return scene.robots[0].links.utorso.localToWorld(at.set(0, 0, 0.2)).project(scene.camera).toArray();
});
const rest = truth.newest.pelvis, from = truth.newest.tick;
await page.mouse.move(scene.x + (chest[0] + 1) / 2 * scene.width, scene.y + (1 - chest[1]) / 2 * scene.height);
await page.mouse.down();
await page.mouse.move(scene.x + (chest[0] + 1) / 2 * scene.width + 40,
                      scene.y + (1 - chest[1]) / 2 * scene.height, {steps: 4});
await shows(page, '#push-label', /: \d+ N/);
const label = await page.locator('#push-label').innerText();
await sleep(400);
await page.mouse.up();
await until('gaitd is not pushed', () => truth.events.some(({text}) => text?.push));
await sleep(500);
const moved = Math.max(...truth.rows.filter(({tick}) => tick > from)
    .map(({pelvis}) => Math.hypot(pelvis[0] - rest[0], pelvis[1] - rest[1])));
console.log(`pushed at the ${label}: the pelvis moved by ${(1000 * moved).toFixed(0)} mm`);
check(moved > 0.004, `a push moves it by ${moved} m`);
await state(page, 'standing');  // it has stepped, or not

// ---- A second viewer who may only watch sees the same, and commands nothing.
const watcher = await open(pages.observe);
await state(watcher, 'standing');
await shows(watcher, '#alerts', /Watching only/);
for (const id of ['arm', 'walk', 'stop', 'sim-reset', 'record']) {
  check(await watcher.locator(`#${id}`).isDisabled(), `who watches may ${id}`);
}
const place = truth.newest.pelvis[0];
await watcher.keyboard.down('KeyW');
await sleep(300);
await watcher.keyboard.up('KeyW');
// Past the buttons, too: it is the server that refuses.
const refusals = await watcher.evaluate(() => Promise.all(
    [['walk', {steps: 2, length: 0.2}], ['drive', {forward: 0.2, session: 1}], ['mode', {mode: 'walk-bent'}], ['arm'], ['stop'],
     ['sim.push', {link: 'utorso', force: [50, 0, 0], duration: 0.1}], ['param.set', {name: 'gait.swing_height', value: 0.2}]]
        .map(([method, params]) => gaitd.connection.call(method, params).then(
            () => `${method} was accepted`, ({code, message}) => code === -32004 ? '' : `${method}: ${code} ${message}`))));
check(refusals.every((text) => !text), refusals.filter(Boolean).join('; '));
await sleep(700);
check(Math.abs(truth.newest.pelvis[0] - place) < 0.03, 'who watches has moved it');
await state(page, 'standing');

// ---- Loaded again it is there again, without its address.
await page.reload();
await becomes(page, () => window.gaitd?.frames > 5);
await state(page, 'standing');
check(/administer/.test(await page.locator('#role').innerText()), 'the role is lost');
await until('after a reload it does not command', async () => {
  await page.locator('#walk-bent').click();
  return page.evaluate(() => gaitd.state.status?.mode === 'walk-bent');
});

// ---- E-stops: of who commands and of who watches. gaitd itself says that they acted.
const fault = async (who, press) => {
  truth.events = [];
  const begin = Date.now();
  await press();
  await until(`the e-stop of ${who} does not act`,
      () => truth.events.some(({kind, text}) => kind === 'fault' && /estop/.test(JSON.stringify(text))));
  console.log(`the e-stop of ${who} acted within ${Date.now() - begin} ms`);
  for (const one of [page, watcher]) {
    await state(one, 'fault');
    await shows(one, '#alerts', /FAULT: estop/);
  }
  // It falls, and lies where it is drawn, not below the ground.
  await sleep(2000);
  const {time, pelvis} = await page.evaluate(() => gaitd.drawn);
  const lies = Math.hypot(...truth.of(time).pelvis.map((value, i) => value - pelvis[i]));
  check(lies < kApart && truth.newest.pelvis[2] < 0.6, `it lies ${lies} m from where it is drawn`);
};
const recover = async () => {
  await page.locator('#reset').click();
  await page.locator('#sim-reset').click();
  await until('it does not stand again', async () => {
    if (/standing/i.test(await page.locator('#state').innerText())) return true;
    await page.locator('#arm').click();
    await sleep(500);
    return false;
  });
};
await page.locator('#walk').click();
await state(page, 'walking');
await fault('who commands', () => page.keyboard.press('Escape'));
await recover();
await fault('who watches', () => watcher.locator('#estop').click());
await recover();
await watcher.context().close();

// ---- gaitd goes, and comes back: no page has to be touched.
process.kill(Number(pid), 'SIGKILL');
await shows(page, '#alerts', /gaitd is away/);
check(await page.locator('#walk').isDisabled(), 'what is away can be told to walk');
const again = spawn('gaitd', ['--set', 'clock=realtime', '--set', 'log.enabled=false'], {stdio: 'ignore'});
process.on('exit', () => again.kill('SIGKILL'));
await until('the alert stays', async () => await page.locator('#alerts').innerText() === '');
await state(page, 'standing');
await truth.open();
const shown = await page.evaluate(() => gaitd.frames);
await until('nothing is drawn', () => page.evaluate((shown) => gaitd.frames > shown + 10, shown));
check(await page.locator('#scene canvas').count() === 1, 'more than one scene');
const home = truth.newest.pelvis[0];
await page.locator('#walk-bent').click();
await page.locator('#walk').click();
await until('the new one does not walk', () => truth.newest.pelvis[0] > home + 0.2);
await until('the new one is not drawn', async () =>
    Math.abs(await page.evaluate(() => gaitd.drawn.pelvis[0]) - truth.newest.pelvis[0]) < 0.1);

check(!errors.length, errors.join('; '));
await browser.close();
again.kill('SIGTERM');
console.log('walks, follows, drives, pushes, refuses, stops and comes back');
process.exit(0);

// For the manual: a desk and a phone. WebP, which only the browser can make here.
async function takePictures(name) {
  const phone = await open(pages.command, {viewport: {width: 390, height: 844}, isMobile: true, hasTouch: true});
  await phone.waitForTimeout(1500);
  for (const [file, shot] of [[name, page], [`${name}-phone`, phone]]) {
    const png = (await shot.screenshot()).toString('base64');
    const blank = await browser.newPage();
    const webp = await blank.evaluate(async (png) => {
      const image = new Image();
      image.src = `data:image/png;base64,${png}`;
      await image.decode();
      const canvas = document.createElement('canvas');
      [canvas.width, canvas.height] = [image.width, image.height];
      canvas.getContext('2d').drawImage(image, 0, 0);
      return canvas.toDataURL('image/webp', 0.85).split(',')[1];
    }, png);
    writeFileSync(`${file}.webp`, Buffer.from(webp, 'base64'));
    if (process.env.GAITD_PNG) writeFileSync(`${file}.png`, Buffer.from(png, 'base64'));
    await blank.close();
  }
  await phone.context().close();
}
