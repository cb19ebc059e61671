// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import {Live} from '../src/view/live.js';

const kSignals = [{name: 'icp/x', unit: 'm'}, {name: 'gait/phase', unit: '', words: ['stand', 'transfer', 'swing']}];

function frame(time, x, phase) {
  const view = new DataView(new ArrayBuffer(16 + 8));
  view.setFloat64(0, time, true);
  view.setFloat64(8, 1000 * time, true);
  view.setFloat32(16, x, true);
  view.setFloat32(20, phase, true);
  return view.buffer;
}

const filled = (rows, capacity = 10) => {
  const live = new Live({signals: kSignals}, capacity);
  for (let i = 0; i < rows; ++i) assert.ok(live.append(frame(i, 0.5 * i, i % 3)));
  return live;
};

test('however many rows come, the newest are there in their order', () => {
  for (const rows of [1, 9, 10, 11, 19, 20, 21, 57, 200]) {
    const live = filled(rows), kept = Math.min(rows, 10);
    assert.equal(live.rows, kept);
    assert.equal(live.end, rows - 1);
    assert.equal(live.start, rows - kept);
    assert.deepEqual([...live.time], Array.from({length: kept}, (_, i) => rows - kept + i));
    assert.deepEqual([...live.column('icp/x')], [...live.time].map((time) => 0.5 * time));
    assert.equal(live.value('icp/x', kept - 1), 0.5 * (rows - 1));
    assert.equal(live.newest('icp/x'), 0.5 * (rows - 1));
  }
});

test('it answers as a log does', () => {
  const live = filled(14);  // times 4 to 13
  assert.equal(live.row(7.5), 3);
  assert.equal(live.row(99), 9);
  assert.equal(live.word('gait/phase', live.row(8)), 'swing');
  assert.deepEqual(live.spans('gait/phase', 'transfer'), [[4, 4], [7, 7], [10, 10], [13, 13]]);
  assert.equal(live.column('nothing'), undefined);
  assert.ok(Number.isNaN(live.value('nothing', 0)));
});

test('a frame of other signals is left out', () => {
  const live = filled(3);
  assert.equal(live.append(new ArrayBuffer(20)), false);
  assert.equal(live.rows, 3);
});

test('a clock that goes back begins anew', () => {
  const live = filled(14);
  live.append(frame(0.5, 1, 0));
  assert.deepEqual([...live.time], [0.5]);
});

test('a missing value stays missing', () => {
  const live = filled(1);
  live.append(frame(1, NaN, 0));
  assert.ok(Number.isNaN(live.newest('icp/x')));
});

test('the parts of a drag are one push', () => {
  const live = filled(3);
  for (let i = 0; i < 10; ++i) {
    live.appendPush({time: 1 + 0.05 * i, text: {push: 'utorso', force: [i, 0, 0], point: [0, 0, 0], duration: 0.08}});
  }
  live.appendPush({time: 1.5, text: {push: 'pelvis', force: [1, 0, 0], point: [0, 0, 0], duration: 0.08}});
  live.appendPush({time: 1.5, text: 'no push'});
  assert.equal(live.pushes.length, 2);
  assert.deepEqual(live.pushes[0].force, [9, 0, 0]);
  assert.ok(Math.abs(live.pushes[0].duration - 0.53) < 1e-9);
});

const step = (side, x) => ({side, position: [x, 0, 0], orientation: [0, 0, 0, 1]});

test('footsteps that come in several commands are one plan, another command is another one', () => {
  const live = filled(3);
  const input = (replace, ...footsteps) => live.appendPlan({time: 1, kind: 'input', text: {type: 6, replace, footsteps}});
  input(true, step(0, 0.1), step(1, 0.2));
  input(false, step(0, 0.3));
  assert.deepEqual(live.plans.map(({steps}) => steps.map(({side}) => side)), [['left', 'right', 'left']]);
  input(true, step(1, 0.5));
  assert.deepEqual(live.plans.map(({steps}) => steps.length), [1]);
  live.appendPlan({time: 2, kind: 'input', text: {type: 23, footsteps: [step(0, 1)]}});
  live.appendPlan({time: 2, kind: 'command', text: {command: 'walk'}});
  assert.equal(live.plans.length, 1);
});
