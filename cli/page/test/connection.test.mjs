// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import {Connection} from '../src/view/connection.js';
import {EStop} from '../src/view/estop.js';
import {fakeClock} from './fake_clock.mjs';

const settle = () => new Promise((resolve) => setImmediate(resolve));

class FakeSocket {
  static all = [];
  constructor(url, protocols) {
    Object.assign(this, {url, protocols, sent: [], bufferedAmount: 0});
    FakeSocket.all.push(this);
  }
  send(text) { this.sent.push(JSON.parse(text)); }
  close() { this.closed = true; }
  says(message) { this.onmessage({data: JSON.stringify(message)}); }
}

function connected(t, options = {}) {
  const clock = fakeClock(t);
  FakeSocket.all = [];
  const connection = new Connection('ws://here/live', 'abc', {Socket: FakeSocket, ...options});
  connection.open();
  const [socket] = FakeSocket.all;
  socket.onopen();
  return {connection, socket, clock};
}

test('it offers the protocol and the token', (t) => {
  const {connection, socket} = connected(t);
  assert.deepEqual(socket.protocols, ['gaitd.v1', 'token.abc']);
  connection.drop();
});

test('answers find their requests, in any order', async (t) => {
  const {connection, socket} = connected(t);
  const one = connection.call('status'), other = connection.call('walk', {steps: 2});
  const [a, b] = socket.sent;
  assert.equal('params' in a, false);
  assert.deepEqual(b.params, {steps: 2});
  socket.says({jsonrpc: '2.0', id: b.id, error: {code: -32000, message: 'refused', data: {tick: 3}}});
  socket.says({jsonrpc: '2.0', id: a.id, result: {tick: 5}});
  assert.deepEqual(await one, {tick: 5});
  await assert.rejects(other, {message: 'refused', code: -32000, data: {tick: 3}});
  connection.drop();
});

test('a request without an answer ends', async (t) => {
  const {connection, socket, clock} = connected(t);
  const call = connection.call('walk', {}, 2);
  clock.tick(2000);
  await assert.rejects(call, /no answer for 2 s/);
  socket.says({jsonrpc: '2.0', id: 1, result: {}});  // too late, and no harm
  connection.drop();
});

test('a lost connection rejects what waits and is opened again, later each time', async (t) => {
  const {connection, socket, clock} = connected(t);
  const call = connection.call('walk');
  socket.onclose();
  await assert.rejects(call, /ended before the answer/);
  assert.equal(connection.state.kind, 'lost');
  await assert.rejects(connection.call('walk'), /not sent/);
  clock.tick(250);
  assert.equal(FakeSocket.all.length, 2);
  FakeSocket.all[1].onclose();
  clock.tick(499);
  assert.equal(FakeSocket.all.length, 2);
  clock.tick(1);
  assert.equal(FakeSocket.all.length, 3);
  connection.drop();
  connection.open('');
});

test('who needs a connection now does not wait for the next try', (t) => {
  const {connection, socket, clock} = connected(t);
  socket.onclose();
  for (let wait = 250; wait < 4000; wait *= 2) {
    clock.tick(wait);
    FakeSocket.all.at(-1).onclose();
  }
  const tried = FakeSocket.all.length;
  connection.hurry();
  assert.equal(FakeSocket.all.length, tried + 1);
  connection.hurry();  // it is on its way
  assert.equal(FakeSocket.all.length, tried + 1);
  FakeSocket.all.at(-1).onclose();
  clock.tick(250);
  assert.equal(FakeSocket.all.length, tried + 2);
  FakeSocket.all.at(-1).onopen();
  connection.hurry();
  assert.equal(FakeSocket.all.length, tried + 2);
  connection.drop();
});

test('it tells what it has seen, and how old that may be', (t) => {
  const {connection, socket, clock} = connected(t);
  const seen = () => socket.sent.filter(({type}) => type === 'seen').map(({frames}) => frames);
  for (let i = 0; i < 8; ++i) socket.onmessage({data: new ArrayBuffer(16)});
  assert.deepEqual(seen(), [4, 8]);
  assert.equal(connection.lag, 0);
  clock.tick(300);
  assert.equal(connection.lag, 0.3);
  socket.says({type: 'seen', frames: 4});
  clock.tick(100);
  assert.equal(connection.lag, 0.3);
  clock.tick(100);  // once in half a second, whatever comes
  assert.deepEqual(seen(), [4, 8, 8]);
  socket.says({type: 'seen', frames: 8});
  socket.says({type: 'seen', frames: 8});
  assert.equal(connection.lag, 0);
  connection.drop();
});

test('a silent connection is given up', (t) => {
  const {connection, socket, clock} = connected(t);
  clock.tick(2900);
  assert.equal(connection.state.kind, 'open');
  clock.tick(600);
  assert.equal(connection.state.kind, 'lost');
  assert.ok(socket.closed);
  connection.drop();
});

test('who is refused by a server that serves pages has the wrong token', async (t) => {
  fakeClock(t);
  FakeSocket.all = [];
  const connection = new Connection('ws://here/live', 'old', {Socket: FakeSocket, answersAt: async () => true});
  connection.open();
  FakeSocket.all[0].onclose();
  await settle();
  assert.equal(connection.state.kind, 'refused');
  assert.match(connection.state.text, /token/);
  connection.drop();
});

test('without a token nothing is tried', (t) => {
  FakeSocket.all = [];
  const connection = new Connection('ws://here/live', '', {Socket: FakeSocket});
  connection.open();
  assert.equal(FakeSocket.all.length, 0);
  assert.equal(connection.state.kind, 'refused');
});

test('messages are events of their type, and what is no message is no error', (t) => {
  const {connection, socket} = connected(t);
  const heard = [];
  connection.addEventListener('hello', ({detail}) => heard.push(detail.role));
  socket.says({type: 'hello', role: 'observe'});
  socket.onmessage({data: 'nonsense'});
  socket.says({type: 5});
  assert.deepEqual(heard, ['observe']);
  connection.drop();
});

test('an e-stop is asked for until it is taken', async (t) => {
  const clock = fakeClock(t);
  const told = [], answers = [];
  const estop = new EStop(() => new Promise((resolve, reject) => answers.push({resolve, reject})),
                          (text, bad) => told.push([text, bad]));
  estop.press();
  clock.tick(500);  // the first one hangs
  assert.equal(answers.length, 2);
  answers[1].resolve({tick: 12});
  await settle();
  clock.tick(20000);
  assert.equal(answers.length, 2);
  assert.equal(told.length, 1);
  assert.match(told[0][0], /tick 12/);
});

test('an e-stop without a connection is sent with the next one, and said to have failed', async (t) => {
  fakeClock(t);
  const told = [];
  let online = false, calls = 0;
  const estop = new EStop(async () => { ++calls; if (!online) throw new Error('no connection'); return {tick: 1}; },
                          (text, bad) => told.push([text, bad]));
  estop.press();
  await settle();
  assert.equal(told[0][1], true);
  online = true;
  estop.online();
  await settle();
  assert.equal(calls, 2);
  assert.equal(estop.pending, false);
  assert.equal(told.at(-1)[1], false);
});

test('an e-stop that nobody takes is given up loudly', async (t) => {
  const clock = fakeClock(t);
  const told = [];
  const estop = new EStop(() => new Promise(() => {}), (text, bad) => told.push([text, bad]));
  estop.press();
  for (let i = 0; i < 25; ++i) clock.tick(500);
  assert.match(told.at(-1)[0], /NOT TAKEN/);
  assert.equal(estop.pending, false);
});
