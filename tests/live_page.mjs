// SPDX-License-Identifier: Apache-2.0
// The live page in a headless browser: live_page.mjs PLAYWRIGHT PAGE URDF [PICTURE]
// Prints what it measured; exit code 1 with the reason if anything is not as it should be.
import {readFileSync} from 'node:fs';

import {LiveServer} from './live_server.mjs';
import {check, launch} from './report_browser.mjs';

const [playwright, page_file, urdf, picture] = process.argv.slice(2);

const kFrames = 20;      // 1/s at least, without a graphics card
const kLatency = 100;    // ms from the arrival of a frame to its drawing
const kSpeed = 0.3;      // m/s of the made-up robot
const kSignals = ['time', 'pelvis/x', 'pelvis/y', 'pelvis/z', 'pelvis/roll', 'pelvis/pitch', 'pelvis/yaw',
                  'icp/x', 'icp/y', 'com/z', 'joint/l_leg_kny/position', 'foot/left/x', 'foot/left/y', 'foot/left/z'];
const kMarkup = '<img src=x onerror="window.broken = true">';  // what a robot's text must never become

let walks = true;  // away from the origin; else it stands there
const row = (time) => {
  const x = walks ? kSpeed * time : 0, sway = Math.sin(5 * time);
  return [time, x, 0, 0.93, 0, 0, 0, x, 0.05 * sway, 1.17, 0.5 + 0.3 * sway, x, 0.1, 0];
};
const parameters = [
  {name: 'gait.swing_height', variant: null, type: 'real', unit: 'm', min: 0.01, max: 0.5, default: 0.13, value: 0.13,
   effect: 'at once', description: `apex ${kMarkup}`},
  {name: 'limits.torque_ratio', variant: null, type: 'real', unit: '', min: 0, max: 1, default: 1, value: 0.9,
   effect: 'at once', description: 'of the effort limits'},
];
const plugins = [
  {layer: 'toe_off', variant: 'icp_criteria', active: true, version: '1', build: '', path: '', worst_case_us: 9},
  {layer: 'toe_off', variant: 'never', active: false, version: '1', build: '', path: '', worst_case_us: 9},
  {layer: 'toe_off', variant: 'odd', path: '', refused: kMarkup},
];
const server = new LiveServer(page_file, 'abc123', {
  name: kMarkup, simulation: true, urdf: readFileSync(urdf, 'utf8'), world: null,
  robot: {legs: {left: {joints: ['l_leg_kny'], knee: 'l_leg_kny'}}},
  signals: kSignals.map((name) => ({name, unit: ''})),
}, row);
const refusal = (message) => ({error: {code: -32000, message}});
server.answer = ({method, params}) => {
  const found = parameters.find(({name}) => name === params?.name);
  switch (method) {
    case 'param.list': return {parameters};
    case 'param.get': return found;
    case 'plugin.list': return {plugins};
    case 'walk': return refusal(`footstep 1: out of reach ${kMarkup}`);
    case 'plugin.swap': return refusal('no swap may begin now');
    case 'param.set':
      if (params.value > found.max) return refusal('param.set: expected a number in 0.01..0.5 m');
      found.value = params.value;
  }
  return {accepted: true, tick: 4711, note: null};
};
const address = await server.listen();

const browser = await launch(playwright);
const errors = [];

async function open(options = {}, token = 'abc123') {
  const context = await browser.newContext({viewport: {width: 1400, height: 900}, ...options});
  const page = await context.newPage();
  page.setDefaultTimeout(120e3);  // a busy machine is no failure
  page.on('console', (message) => message.type() === 'error' && !/WebSocket/.test(message.text()) &&
      errors.push(message.text()));
  page.on('pageerror', (error) => errors.push(String(error)));
  page.on('request', (request) => request.url().startsWith(address) || /^(data|blob):/.test(request.url()) ||
      errors.push(`request of ${request.url()}`));
  await page.goto(`${address}#renderer=software&token=${token}`);
  return page;
}

async function until(what, holds) {
  for (let tries = 0; tries < 600; ++tries) {
    if (await holds()) return;
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
  check(false, what);
}

// `holds` in the page; playwright's own way to wait evaluates text there, which the page forbids.
const becomes = (page, holds) => until(`never: ${holds}`, () => page.evaluate(holds));

const page = await open();
const text = (selector) => page.locator(selector).innerText();
const shows = (selector, pattern) => until(`no ${pattern} in ${selector}`, async () => pattern.test(await text(selector)));
await becomes(page, () => window.gaitd?.frames > 5);
check(!(await page.evaluate(() => location.href)).includes('abc123'), 'the token stays in the address');

// Frames are read as they were sent, and the newest is drawn in time.
let best = 0, latency;
for (let tries = 0; tries < 20 && !(best >= kFrames && latency.mean < kLatency); ++tries) {
  const before = await page.evaluate(() => ({frames: gaitd.frames, now: performance.now()}));
  await page.waitForTimeout(1500);
  const after = await page.evaluate(() => ({frames: gaitd.frames, now: performance.now(), drawn: gaitd.drawn,
      latency: {...gaitd.latency}, plots: gaitd.plots.length, rows: gaitd.live.rows}));
  const {drawn: {time, pelvis}} = after;
  check(Math.abs(pelvis[0] - kSpeed * time) < 1e-3 * time, `at ${time} s the pelvis is drawn at ${pelvis}`);
  check(after.plots > 0 && after.rows > 10, `${after.plots} plots of ${after.rows} rows`);
  best = Math.max(best, 1000 * (after.frames - before.frames) / (after.now - before.now));
  latency = after.latency;
  console.log(`${best.toFixed(1)} frames/s, drawn ${latency.mean.toFixed(1)} ms after their arrival, ` +
              `at most ${latency.longest.toFixed(0)} ms`);
}
check(best >= kFrames && latency.mean < kLatency, 'too slow');
if (picture) await page.screenshot({path: `${picture}.png`});

// What is held drives, and what is let go, or not looked at, does not.
const meta = () => page.evaluate(() => {  // macOS tells nothing of the key that is let go meanwhile
  for (const type of ['keydown', 'keyup']) dispatchEvent(new KeyboardEvent(type, {key: 'Meta', code: 'MetaLeft'}));
});
for (const letGo of [() => page.keyboard.up('KeyW'), meta,
                     () => page.evaluate(() => dispatchEvent(new Event('blur')))]) {
  server.forget();
  await page.keyboard.down('KeyW');
  await until('the key W does not drive', () => server.calls('drive').length > 3);
  await letGo();
  await until('it drives on', () => server.calls('drive').at(-1).end === true);
  const calls = server.calls('drive');
  check(calls[0].renew === false && calls[0].forward > 0, `it begins with ${JSON.stringify(calls[0])}`);
  check(calls.slice(1, -1).every(({renew}) => renew), 'it does not renew');
  check(calls.every(({session}) => session === calls[0].session), 'it changes its session');
  await page.waitForTimeout(300);
  check(server.calls('drive').length === calls.length, 'it drives on');
  await page.keyboard.up('KeyW');
}

// The stick, and a walk first.
server.status.mode = 'stand';
await shows('#status', /stand/);
await becomes(page, () => gaitd.state.status.mode === 'stand');
server.forget();
const stick = await page.locator('#stick').boundingBox();
await page.mouse.move(stick.x + stick.width / 2, stick.y + stick.height / 2);
await page.mouse.down();
await page.mouse.move(stick.x + stick.width / 2, stick.y + 2);
await until('the stick does not drive', () => server.calls('drive').some(({forward}) => forward > 0));
check(server.asked[0].method === 'mode' && server.asked[0].params.mode === 'walk-straight', 'it does not walk first');
await page.mouse.up();
await until('the stick drives on', () => server.calls('drive').at(-1).end === true);
server.status.mode = 'walk-bent';

// A gamepad drives if the browser knows its layout, from when it was seen at rest.
const pad = (mapping, turn) => page.evaluate(([mapping, turn]) => {
  navigator.getGamepads = () => [{index: 0, connected: true, mapping, axes: [0, 0, turn, 0], buttons: []}];
}, [mapping, turn]);
for (const [mapping, first] of [['', 0], ['standard', -1]]) {
  server.forget();
  await pad(mapping, first);
  await page.waitForTimeout(300);
  await pad(mapping, -1);
  await page.waitForTimeout(400);
  check(!server.calls('drive').length, `a gamepad of the layout '${mapping}' drives, at first at ${first}`);
}
await pad('standard', 0);
await page.waitForTimeout(300);
await pad('standard', -1);
await until('the gamepad does not drive', () => server.calls('drive').some(({turn}) => turn > 0));
await pad('standard', 0);
await until('the gamepad drives on', () => server.calls('drive').at(-1).end === true);
await page.evaluate(() => { navigator.getGamepads = () => []; });

// A gaitd that does not answer: the last that it said is shown as what it is, old.
server.silent = 4;
await shows('#alerts', /has not answered for 4 s/);
check(await page.evaluate(() => document.body.classList.contains('away')), 'an old picture looks like a new one');
check(/standing/.test(await text('#state')), 'the last state is gone');
check(!/as it should be/.test(await text('#status')) || /standing/.test(await text('#status')), 'it looks calm');
server.silent = 0;
await until('the alert stays', async () => !/has not answered/.test(await text('#alerts')));

// Nor is what a slow connection brings a robot of now.
server.slow = true;
await shows('#alerts', /slow connection: all that is shown may be \d+\.\d s old/);
check(await page.evaluate(() => document.body.classList.contains('away')), 'an old picture looks like a new one');
server.slow = false;
await until('the alert of a slow connection stays', async () => !/slow connection/.test(await text('#alerts')));

// Who drags a link pushes it; elsewhere the camera turns.
const scene = await page.locator('#scene').boundingBox();
const drag = async (x, y) => {
  server.forget();
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 100, y, {steps: 5});
  await page.waitForTimeout(400);
  await page.mouse.up();
};
const camera = () => page.evaluate(() => gaitd.scene.camera.position.clone().sub(gaitd.scene.controls.target).toArray());
const chest = await page.evaluate(() => {
  const {scene} = gaitd, at = scene.camera.position.clone();
  return scene.robots[0].links.utorso.localToWorld(at.set(0, 0, 0.2)).project(scene.camera).toArray();
});
const before = await camera();
await drag(scene.x + (chest[0] + 1) / 2 * scene.width, scene.y + (1 - chest[1]) / 2 * scene.height);
const pushes = server.calls('sim.push');
check(pushes.length >= 3, `${pushes.length} pushes`);
const {link, force, point, duration} = pushes.at(-1);
check(/^[a-z_]+$/.test(link) && point.length === 3 && duration > 0, JSON.stringify(pushes.at(-1)));
check(Math.hypot(...force) > 50 && Math.hypot(...force) <= 500.1, `pushed with ${force} N`);
const turned = (one, other) => Math.hypot(...one.map((value, i) => value - other[i]));
check(turned(before, await camera()) < 1e-6, 'the camera turns while a link is dragged');
await drag(scene.x + 30, scene.y + scene.height - 30);
check(!server.calls('sim.push').length, 'dragging the ground pushes');
check(turned(before, await camera()) > 0.1, 'dragging the ground does not turn the camera');

// The ground as it is known, and a place on it: by a click, with the heading by a drag.
walks = false;  // or what is clicked at leaves the picture, the sooner the busier the machine
await becomes(page, () => gaitd.drawn.pelvis[0] === 0);
check(await page.evaluate(() => !gaitd.scene.ground.mesh.visible), 'ground is drawn that nobody knows');
const kCells = 200, heights = new Int16Array(kCells * kCells).fill(-32768);
for (let j = 40; j < 160; ++j) heights.fill(250, j * kCells + 20, j * kCells + 180);  // 0.25 m
server.map = {revision: 7, columns: kCells, rows: kCells, resolution: 0.04, origin: [-4, -4], scale: 0.001,
              heights: Buffer.from(heights.buffer).toString('base64')};
await becomes(page, () => gaitd.scene.ground.mesh.visible);
const bounds = await page.evaluate(() => {
  const {geometry} = gaitd.scene.ground.mesh;
  geometry.computeBoundingBox();
  return {...geometry.boundingBox, faces: geometry.index.count / 3};
});
check(Math.abs(bounds.max.z - 0.25) < 0.01 && bounds.min.x < -3 && bounds.max.x > 2.5, JSON.stringify(bounds));
check(bounds.faces > 1000 && bounds.faces < 24000, `${bounds.faces} faces`);
const onScreen = (point) => page.evaluate((p) => {
  const {scene} = gaitd, at = scene.camera.position.clone().set(...p).project(scene.camera);
  return [at.x, at.y];
}, point).then(([x, y]) => [scene.x + (x + 1) / 2 * scene.width, scene.y + (1 - y) / 2 * scene.height]);
const goal = [0.6, 0.8, 0.253], ahead = [0.6, 1.4, 0.253];
server.forget();
await page.locator('#goto').click();
check(await page.locator('#goto').getAttribute('aria-pressed') === 'true', 'the button does not stay down');
const looked = await camera();
await page.mouse.move(...await onScreen(goal));
await page.mouse.down();
await page.mouse.move(...await onScreen(ahead), {steps: 4});
await page.mouse.up();
await until('it does not go there', () => server.calls('goto').length === 1);
const [asked] = server.calls('goto');
check(Math.hypot(asked.x - goal[0], asked.y - goal[1]) < 0.03, `it goes to ${JSON.stringify(asked)}`);
check(Math.abs(asked.yaw - Math.PI / 2) < 0.1, `it looks to ${asked.yaw}`);
check(turned(looked, await camera()) < 1e-6, 'the camera turns while one says where to look');
check(await page.locator('#goto').getAttribute('aria-pressed') === 'false', 'the button stays down');
server.event('input', {type: 6, replace: true, footsteps: [
  {side: 0, position: [0.3, 0.1, 0], orientation: [0, 0, 0, 1]},
  {side: 1, position: [0.6, -0.1, 0.25], orientation: [0, 0, 0, 1]}]});
await becomes(page, () => gaitd.live.plans.at(-1)?.steps.length === 2);

// Refusals are shown; nothing that the robot says is taken for a part of the page.
await page.locator('#walk').click();
await shows('#toasts', /out of reach <img/);
server.event('note', kMarkup);
server.event('fault', {fault: kMarkup});
server.status.faults = [kMarkup];
await shows('#alerts', /FAULT: <img/);
server.status.faults = [];
await page.getByRole('tab', {name: 'Events'}).click();
await shows('#events', /<img/);
await page.getByRole('tab', {name: 'Layers'}).click();
await page.locator('.layer button', {hasText: 'Swap'}).click();
await shows('#layers', /no swap may begin now/);

// Parameters show what gaitd has, not what was asked for.
await page.getByRole('tab', {name: 'Parameters'}).click();
await page.locator('#filter').fill('apex');
const height = page.locator('.parameter input[type=number]');
await height.fill('0.2');
await height.press('Enter');
await until('the parameter is not set', () => parameters[0].value === 0.2);
await page.locator('.parameter.changed').waitFor();
await height.fill('9');
await height.press('Enter');
await shows('#toasts', /expected a number/);
await until('what was refused stays', async () => await height.inputValue() === '0.2');
await page.locator('.parameter button', {hasText: 'Default'}).click();
await until('it does not go back', () => parameters[0].value === 0.13);
check(!await page.evaluate(() => window.broken || document.querySelector('img')), 'text became a part of the page');

// Space stops, whatever has the focus; an e-stop is sent while nothing else is answered, also from a field.
server.forget();
await page.locator('#walk').focus();
await page.keyboard.press('Space');
await until('space does not stop', () => server.calls('stop').length === 1);
check(!server.calls('walk').length, 'space presses the button that has the focus');
await page.locator('#steps').focus();  // also a number
await page.keyboard.press('Space');
await until('space does not stop in a field of numbers', () => server.calls('stop').length === 2);
await page.locator('#filter').focus();
await page.keyboard.press('Space');
check((await page.locator('#filter').inputValue()).includes(' '), 'nobody can write a space');
server.hangs = true;
await page.locator('#arm').click();
await page.locator('#filter').focus();
await page.keyboard.press('Escape');
await shows('#toasts', /E-stop taken at tick 4711/);
server.hangs = false;
server.forget();
await page.locator('#estop').click();
await until('the button is no e-stop', () => server.calls('estop').length > 0);

// gaitd goes and comes back; so does the server.
server.setAway(true);
await shows('#alerts', /gaitd is away: the socket is gone/);
check(await page.locator('#arm').isDisabled() && !await page.locator('#estop').isDisabled(), 'away: wrong buttons');
server.setAway(false);
await until('the alert stays', async () => await text('#alerts') === '');
server.drop();
await shows('#alerts', /lost/);
await until('it does not come back', async () => await text('#alerts') === '');
await becomes(page, () => gaitd.live?.rows > 2 && document.querySelectorAll('#scene canvas').length === 1);

// Who may only watch can do no more than stop the robot.
server.role = 'observe';
const watcher = await open();
await becomes(watcher, () => gaitd.frames > 2);
check(/Watching only/.test(await watcher.locator('#alerts').innerText()), 'nothing says that one only watches');
for (const id of ['arm', 'walk', 'stop', 'sim-reset', 'record']) {
  check(await watcher.locator(`#${id}`).isDisabled(), `who watches may ${id}`);
  check(await watcher.locator(`#${id}`).getAttribute('title'), `${id} does not say why it cannot be used`);
}
await shows('#viewers', /2 watch/);
server.forget();
await watcher.keyboard.press('Space');
await watcher.locator('#toasts', {hasText: 'stop: watching only'}).waitFor();
await watcher.keyboard.press('KeyW');
await watcher.keyboard.press('Escape');
await until('who watches cannot stop the robot', () => server.calls('estop').length > 0);
check(!server.calls('drive').length, 'who watches drives');
await watcher.context().close();
await until('who has gone watches', async () => await text('#viewers') === '');
server.role = 'administer';

// The wrong token.
const stranger = await open({}, 'wrong');
await stranger.locator('#alerts', {hasText: 'its token is not'}).waitFor();
await stranger.context().close();

// A phone: one column, stick and E-STOP in sight wherever it is scrolled to.
const phone = await open({viewport: {width: 390, height: 844}, isMobile: true, hasTouch: true});
await becomes(phone, () => gaitd.frames > 2);
check(await phone.evaluate(() => document.documentElement.scrollWidth <= innerWidth), 'a phone scrolls sideways');
for (const to of [0, 1e6]) {
  await phone.evaluate((to) => scrollTo(0, to), to);
  for (const id of ['stick', 'estop', 'stop']) {
    const {x, y, width, height} = await phone.locator(`#${id}`).boundingBox();
    check(x >= 0 && x + width <= 390 && y >= 500 && y + height <= 844, `${id} is at ${x}, ${y} of the phone`);
  }
}
server.forget();
await phone.locator('#estop').tap();
await until('a tap is no e-stop', () => server.calls('estop').length > 0);
if (picture) await phone.screenshot({path: `${picture}-phone.png`});

check(!errors.length, errors.join('; '));
await browser.close();
server.close();
console.log('drives, pushes, stops, refuses and comes back');
