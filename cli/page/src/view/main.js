// SPDX-License-Identifier: Apache-2.0
import '../shared/base.css';
import './view.css';
import {addLegend} from '../shared/legend.js';
import {addCommands} from './commands.js';
import {Connection} from './connection.js';
import {$, say} from '../shared/dom.js';
import {Drive} from './drive.js';
import {DriveKeys} from './drive_keys.js';
import {EStop} from './estop.js';
import {parsed} from './event_list.js';
import {Events} from './events.js';
import {readGamepads} from './gamepad.js';
import {GoThere} from './go_there.js';
import {listenToKeys} from './keys.js';
import {Layers} from './layers.js';
import {MapWatch} from './map_watch.js';
import {Parameters} from './parameters.js';
import {reachOf, velocityOf} from './reach.js';
import {addRecord} from './record.js';
import {Stage} from './stage.js';
import {State} from './state.js';
import {addStatus} from './status_panel.js';
import {addStick} from './stick.js';
import {addTabs} from './tabs.js';
import {tell} from './toast.js';
import {takeToken} from './token.js';

const kShownRate = 60, kHiddenRate = 5;  // frames/s
const kSettled = 300;  // ms: changes of parameters and layers come in crowds
const kDriveAnswer = 2, kPushAnswer = 2;  // s

const connection = new Connection(
    `${location.protocol === 'https:' ? 'wss' : 'ws'}://${location.host}/live`, takeToken(),
    {answersAt: async () => Boolean(await fetch('/', {method: 'HEAD', cache: 'no-store'}))});
const state = new State(connection);
const call = (...request) => connection.call(...request);
const congested = () => connection.congested;

let stage, frames = 0;

// E-stop.
const estop = new EStop((...request) => {
  connection.hurry();
  return call(...request);
}, tell);
function stopAtOnce() {
  estop.press();
  letGo();
}
$('estop').addEventListener('pointerdown', stopAtOnce);  // not when it is let go
$('estop').addEventListener('click', (event) => event.detail === 0 && stopAtOnce());  // by a key
connection.addEventListener('state', ({detail}) => detail.kind === 'open' && estop.online());

const commands = addCommands(state, call);
addStatus(state, connection);
const events = new Events();
const parameters = new Parameters(state, call);
const layers = new Layers(state, call);
addRecord(state, connection, () => stage?.live.end ?? NaN);
addTabs((name) => stage && name === 'plots' && stage.plots.resize());
addLegend($('legend'), true);

// Driving.
const height = () => {
  const {live} = stage ?? {};
  return live ? live.newest('com/z') - Math.min(live.newest('foot/left/z'), live.newest('foot/right/z')) : NaN;
};
let reach;  // the same as long as one drives: the robot bobs
const drive = new Drive({
  call: (method, params) => call(method, params, kDriveAnswer),
  scale: (shares) => {
    reach ??= reachOf(parameters.list, height());
    return velocityOf(shares, reach, Number($('speed').value) / 100);
  },
  mode: () => state.status?.mode, congested, tell,
});
const releaseStick = addStick($('stick'), $('strip'), drive);
const keys = new DriveKeys(drive);
const gamepads = readGamepads(drive, {stop: commands.stop, estop: stopAtOnce});

function showDrive() {
  const obstacle = state.obstacle('drive');
  for (const id of ['stick', 'strip']) {
    $(id).classList.toggle('off', Boolean(obstacle));
    $(id).title = obstacle;
  }
  say($('drive-note'), drive.driving ? drive.notes : '');
  if (!drive.driving) {
    reach = undefined;
    say($('drive-velocity'), obstacle);
    return;
  }
  const {forward, lateral, turn} = drive.velocity;
  const sideways = lateral ? `, ${Math.abs(lateral).toFixed(2)} to the ${lateral > 0 ? 'left' : 'right'}` : '';
  say($('drive-velocity'), `${forward.toFixed(2)} m/s${sideways}, ${turn.toFixed(2)} rad/s`);
}
drive.addEventListener('change', showDrive);
state.addEventListener('change', showDrive);
showDrive();

listenToKeys({
  estop: stopAtOnce, stop: commands.stop,
  isDriving: (code) => keys.held.has(code),
  driveDown: (code) => {
    const obstacle = keys.knows(code) && state.obstacle('drive');
    if (obstacle) tell(`drive: ${obstacle}`, true);
    return obstacle ? false : keys.down(code);
  },
  driveUp: (code) => keys.up(code),
  release: () => keys.release(),
});

// Who does not see the page does not hold the stick.
function letGo() {
  releaseStick();
  keys.release();
  gamepads.release();
  drive.release();
  stage?.push.release();
}
addEventListener('blur', letGo);
addEventListener('pagehide', letGo);
const tellRate = () => connection.send({type: 'rate', hz: document.hidden ? kHiddenRate : kShownRate});
document.addEventListener('visibilitychange', () => {
  if (document.hidden) letGo();
  else connection.hurry();
  tellRate();
});
addEventListener('online', () => connection.hurry());

// Where to go, and the ground.
const goThere = new GoThere(state, call);
const map = new MapWatch(state, call, (known) => {
  if (!stage) return;
  stage.scene.ground.show(known);
  stage.scene.stale = true;
});

// The robot.
const push = {
  call: (method, params) => call(method, params, kPushAnswer), congested, tell, label: $('push-label'),
  allowed: () => !state.obstacle('sim.push'),
};
connection.addEventListener('hello', tellRate);
connection.addEventListener('robot', ({detail}) => {
  if (!detail.connected) {
    letGo();
    return;
  }
  const view = stage?.view;
  stage?.remove();
  stage = new Stage(detail, push, frames);
  goThere.attach(stage.scene);
  map.restart();
  if (view) stage.view = view;
  parameters.load();
  layers.load();
});
state.addEventListener('status', () => {
  if (stage) stage.fallen = state.simulation && state.status?.state === 'fault';
});
connection.onframe = (buffer) => stage?.append(buffer);

let settling, changed = new Set();
layers.onswap = () => parameters.load();
connection.addEventListener('event', ({detail}) => {
  const event = parsed(detail.event);
  stage?.live.appendPush(event);
  stage?.live.appendPlan(event);
  events.add(event);
  if (event.kind !== 'swap' && event.kind !== 'parameter') return;
  changed.add(event.kind === 'parameter' ? event.text?.name : undefined);
  clearTimeout(settling);
  settling = setTimeout(() => {
    if (changed.has(undefined)) {
      layers.load();
      parameters.load();
    } else {
      for (const name of changed) parameters.read(name);
    }
    changed = new Set();
  }, kSettled);
});

let last = performance.now(), counted = last, before = 0;
function frame(now) {
  gamepads.read();
  stage?.draw(now, now - last);
  frames = stage?.frames ?? 0;
  last = now;
  if (now > counted + 1000) {
    const rate = 1000 * (frames - before) / (now - counted);
    say($('speedometer'), stage ? `${rate.toFixed(0)} /s, ${stage.latency.mean.toFixed(0)} ms` : '');
    [counted, before] = [now, frames];
  }
  requestAnimationFrame(frame);
}
requestAnimationFrame(frame);

addEventListener('hashchange', () => connection.open(takeToken()));  // another address in the same tab
connection.open();

// For the console of the browser, and for tests.
window.gaitd = {
  connection, state, drive, estop, parameters, layers,
  get live() { return stage?.live; },
  get scene() { return stage?.scene; },
  get plots() { return stage?.plots.plots; },
  get frames() { return frames; },
  get drawn() { return stage?.drawn; },
  get latency() { return stage?.latency; },
};
