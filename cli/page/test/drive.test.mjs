// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import {Drive} from '../src/view/drive.js';
import {DriveKeys} from '../src/view/drive_keys.js';
import {readGamepads, wantedOf} from '../src/view/gamepad.js';
import {reachOf, velocityOf} from '../src/view/reach.js';
import {fakeClock} from './fake_clock.mjs';

const kAhead = {forward: 1, lateral: 0, turn: 0}, kNothing = {forward: 0, lateral: 0, turn: 0};
const settle = () => new Promise((resolve) => setImmediate(resolve));

function driven({mode = 'walk-bent', answer = async () => ({note: null}), congested = () => false} = {}) {
  const calls = [], told = [];
  const drive = new Drive({
    call: (method, params) => { calls.push({method, ...params}); return answer(method, params); },
    scale: (shares) => shares, mode: () => mode, congested, tell: (text) => told.push(text), session: 7});
  return {drive, calls, told};
}

test('the first call begins, later ones renew, letting go ends it once', async (t) => {
  const clock = fakeClock(t);
  const {drive, calls} = driven();
  drive.want('stick', kAhead);
  await settle();
  clock.tick(100);
  await settle();
  clock.tick(100);
  await settle();
  drive.want('stick', kNothing);
  await settle();
  clock.tick(1000);
  assert.deepEqual(calls.map(({forward, renew, end}) => [forward, renew, end]),
                   [[1, false, undefined], [1, true, undefined], [1, true, undefined], [undefined, undefined, true]]);
  assert.ok(calls.every(({method, session}) => method === 'drive' && session === 7));
});

test('in the mode stand it walks first', async (t) => {
  fakeClock(t);
  const {drive, calls} = driven({mode: 'stand'});
  drive.want('stick', kAhead);
  await settle();
  assert.deepEqual(calls.map(({method}) => method), ['mode', 'drive']);
  assert.equal(calls[0].mode, 'walk-straight');
  drive.release();
});

test('who lets go while the mode is set does not drive', async (t) => {
  const clock = fakeClock(t);
  const {drive, calls} = driven({mode: 'stand'});
  drive.want('stick', kAhead);
  drive.want('stick', kNothing);
  await settle();
  clock.tick(1000);
  assert.deepEqual(calls.map(({method}) => method), ['mode']);
});

test('a refusal is told once, and nothing is sent until all let go', async (t) => {
  const clock = fakeClock(t);
  const {drive, calls, told} = driven({answer: async () => { throw new Error('somebody else drives'); }});
  drive.want('stick', kAhead);
  await settle();
  clock.tick(1000);
  drive.want('stick', {...kAhead, forward: 0.5});
  await settle();
  assert.equal(calls.length, 1);
  assert.deepEqual(told, ['drive: somebody else drives']);
  drive.want('stick', kNothing);
  drive.want('stick', kAhead);
  await settle();
  assert.equal(calls.length, 2);
  assert.equal(calls[1].renew, false);
});

test('a refusal that comes after letting go is told too', async (t) => {
  fakeClock(t);
  const {drive, told} = driven({answer: async () => { throw new Error('disarmed'); }});
  drive.want('stick', kAhead);
  drive.want('stick', kNothing);
  await settle();
  assert.deepEqual(told, ['drive: disarmed']);
});

test('a gaitd that does not answer is not flooded', async (t) => {
  const clock = fakeClock(t);
  const {drive, calls} = driven({answer: () => new Promise(() => {})});
  drive.want('stick', kAhead);
  await settle();
  clock.tick(5000);
  assert.equal(calls.length, 3);
  drive.release();
});

test('stick, keys and gamepad add up to no more than all', async (t) => {
  fakeClock(t);
  const {drive} = driven();
  drive.want('stick', kAhead);
  drive.want('keys', {forward: 1, lateral: 0, turn: 0.5});
  assert.deepEqual(drive.velocity, {forward: 1, lateral: 0, turn: 0.5});
  drive.release();
  assert.deepEqual(drive.velocity, kNothing);
});

test('keys want what is held', () => {
  const wants = [], keys = new DriveKeys({want: (_, wanted) => wants.push(wanted)});
  assert.ok(keys.down('KeyW'));
  keys.down('KeyA');
  keys.up('KeyW');
  keys.release();
  assert.equal(keys.down('KeyX'), false);
  assert.deepEqual(wants.map(({forward, turn}) => [forward, turn]), [[1, 0], [1, 1], [0, 1], [0, 0]]);
});

test('a gamepad at rest, or gone, wants nothing', () => {
  assert.deepEqual(wantedOf(undefined), kNothing);
  assert.deepEqual(wantedOf({axes: [0.1, -0.1, 0.05, 0]}), kNothing);
  const {forward, lateral, turn} = wantedOf({axes: [0, -1, 1, 0]});
  assert.deepEqual([forward, lateral, turn], [1, 0, -1]);
});

test('a gamepad drives from when it was seen at rest, anew after each loss of the focus', (t) => {
  let focus = true, turn = 0, wanted;
  globalThis.document = {hasFocus: () => focus};
  t.after(() => { delete globalThis.document; });
  const source = {getGamepads: () =>
      [{index: 0, connected: true, mapping: 'standard', axes: [0, 0, turn], buttons: []}]};
  const pad = readGamepads({want: (_, one) => { wanted = one.turn; }}, {}, source);
  const drives = (now) => {
    turn = now;
    pad.read();
    return wanted !== 0;
  };
  assert.equal(drives(-1), false);
  assert.equal(drives(0), false);
  assert.equal(drives(-1), true);
  focus = false;
  assert.equal(drives(-1), false);
  assert.equal(drives(0), false);  // nor what it did while nobody looked
  focus = true;
  assert.equal(drives(-1), false);
  drives(0);
  assert.equal(drives(-1), true);
  pad.release();
  assert.equal(drives(-1), false);
});

test('a whole push is the share of the fastest that is set, half of it backwards', () => {
  const reach = reachOf([{name: 'drive.max_forward', value: 0.2}], 1);
  assert.ok(Math.abs(reach.forward - 0.2 * Math.sqrt(9.81)) < 1e-9);
  assert.equal(velocityOf({forward: 1, lateral: 0, turn: 0}, reach, 0.5).forward, 0.313);
  assert.equal(velocityOf({forward: -1, lateral: 0, turn: 0}, reach, 0.5).forward, -0.157);
  assert.ok(reachOf([], NaN).turn > 0);
});
