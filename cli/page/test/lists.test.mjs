// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import {parsed, sentence, subject} from '../src/view/event_list.js';
import {grouped, isChanged, shown, stepOf} from '../src/view/parameter_list.js';
import {refused} from '../src/view/refused.js';
import {obstacle} from '../src/view/rights.js';
import {roundRange} from '../src/view/round_range.js';
import {kMostForce, springForce} from '../src/view/spring.js';

const kThere = {online: true, connected: true, role: 'administer', simulation: true, status: {state: 'standing'}};

test('every role may stop the robot, and gaitd being away does not forbid it', () => {
  assert.equal(obstacle('estop', {...kThere, role: 'observe', connected: false}), '');
});

test('buttons say what is missing', () => {
  assert.equal(obstacle('walk', kThere), '');
  assert.match(obstacle('walk', {...kThere, role: 'observe'}), /watching only/);
  assert.match(obstacle('walk', {...kThere, connected: false}), /away/);
  assert.match(obstacle('walk', {...kThere, online: false}), /no connection/);
  assert.match(obstacle('sim.push', {...kThere, role: 'command'}), /administer/);
  assert.match(obstacle('sim.reset', {...kThere, simulation: false}), /simulation/);
  assert.equal(obstacle('param.set', {...kThere, role: 'command'}, 'gait.swing_height'), '');
  assert.match(obstacle('param.set', {...kThere, role: 'command'}, 'limits.torque_ratio'), /administer/);
  assert.match(obstacle('param.set', {...kThere, simulation: false}, 'limits.torque_ratio'), /disarmed/);
});

test('a pull grows with the way, and no further than it may', () => {
  assert.deepEqual(springForce([1, 1, 1], [1, 1, 1]), [0, 0, 0]);
  assert.ok(Math.hypot(...springForce([0, 0, 0], [0.1, 0, 0])) < kMostForce);
  const [x, y] = springForce([0, 0, 0], [-30, 40, 0]);
  assert.ok(Math.abs(Math.hypot(x, y) - kMostForce) < 1e-9 && x < 0 && y > 0);
});

test('the filter asks for all words, in names and descriptions', () => {
  const list = [{name: 'gait.swing_height', description: 'apex above the ground'},
                {name: 'gait.omega', description: 'of the ICP'},
                {name: 'limits.torque_ratio', description: 'clamp'}];
  assert.deepEqual(grouped(list, '').map(([scope, of]) => [scope, of.length]), [['gait', 2], ['limits', 1]]);
  assert.deepEqual(grouped(list, 'GAIT apex').map(([, [{name}]]) => name), ['gait.swing_height']);
  assert.deepEqual(grouped(list, 'nothing like it'), []);
});

test('parameters know whether they were changed', () => {
  assert.equal(isChanged({value: 0.1, default: 0.1 + 1e-15}), false);
  assert.equal(isChanged({value: 0.1, default: 0.12}), true);
  assert.equal(isChanged({value: false, default: true}), true);
  assert.equal(shown(0.1 + 0.2), '0.3');
  assert.equal(stepOf({type: 'integer', min: 0, max: 9}), 1);
  assert.equal(stepOf({type: 'real', min: 0, max: 1}), 0.001);
});

test('events are read as they come', () => {
  const event = parsed({kind: 'fault', time: 1, text: '{"fault":"estop"}'});
  assert.equal(sentence(event), 'fault estop');
  assert.equal(subject(event), undefined);
  assert.equal(sentence(parsed({kind: 'note', text: 'no {JSON'})), 'no {JSON');
  const push = parsed({kind: 'command', text: '{"push":"utorso","force":[1,2,3]}'});
  assert.equal(subject(push), subject(parsed({kind: 'command', text: '{"push":"utorso","force":[3,2,1]}'})));
  assert.equal(sentence({text: {request: 7, force: [1.23456789], accepted: true, command: 'sim.push'}}),
               'command sim.push, accepted true, force [1.2346]');
  assert.equal(sentence({text: {faults: ['estop', 'overrun'], state: 'fault'}}), 'faults estop overrun, state fault');
  assert.equal(sentence({text: {faults: [], state: 'standing'}}), 'state standing');
});

test('a plot shows all, little more, and not the noise of a robot that stands', () => {
  for (const [low, high, least] of [[1.1768, 1.1769, 0.05], [-3, 5, 0.05], [0, 0, 100], [2, 2, 0], [-0.2, 0.15, 0.1]]) {
    const [from, to] = roundRange(low, high, least), span = Math.max(high - low, least);
    assert.ok(from < low && to > high && to - from >= least && to - from <= (span || 1) * 2.2, `${from} to ${to}`);
  }
  assert.deepEqual(roundRange(null, null, 0.1), [0, 0.1]);
});

test('who refuses is named once', () => {
  assert.equal(refused('drive', {message: 'drive: no'}), 'drive: no');
  assert.equal(refused('Arm', {message: 'arm: no'}), 'arm: no');
  assert.equal(refused('Walk', {message: 'footstep 1: no'}), 'Walk: footstep 1: no');
});
