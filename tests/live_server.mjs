// SPDX-License-Identifier: Apache-2.0
// What `gaitctl view` is for its page, without a gaitd: serves the page and speaks to it over a
// WebSocket (RFC 6455: text and binary, no fragments). Its robot is made up.
import {createHash} from 'node:crypto';
import {readFileSync} from 'node:fs';
import {createServer} from 'node:http';

const kPolicy = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; " +
    "img-src data: blob:; connect-src 'self'";

function framed(data) {
  const body = Buffer.from(data), head = [typeof data === 'string' ? 0x81 : 0x82];
  if (body.length < 126) head.push(body.length);
  else if (body.length < 65536) head.push(126, body.length >> 8, body.length & 255);
  else head.push(127, 0, 0, 0, 0, ...[24, 16, 8, 0].map((shift) => body.length >> shift & 255));
  return Buffer.concat([Buffer.from(head), body]);
}

// The text messages in `bytes`, and what is left of it.
function unframed(bytes) {
  const texts = [];
  while (bytes.length >= 6) {
    let size = bytes[1] & 127, at = 2;
    if (size === 126) [size, at] = [bytes.readUInt16BE(2), 4];
    if (bytes.length < at + 4 + size) break;
    const mask = bytes.subarray(at, at + 4), body = Buffer.from(bytes.subarray(at + 4, at + 4 + size));
    for (let i = 0; i < size; ++i) body[i] ^= mask[i & 3];
    if ((bytes[0] & 15) === 1) texts.push(body.toString());
    bytes = bytes.subarray(at + 4 + size);
  }
  return [texts, bytes];
}

export class LiveServer {
  // `robot`: the message of that type; `row(time)`: values of its signals.
  constructor(page, token, robot, row) {
    Object.assign(this, {page, token, robot, row, role: 'administer', away: false, hangs: false, silent: 0, slow: false,
                         answer: () => ({accepted: true, tick: 1, note: null}), asked: []});
    this.status = {state: 'standing', mode: 'walk-bent', faults: [], phase: 'stand', layers: []};
    this.map = {revision: 0};
    this.viewers = new Set();
    this.server = createServer((request, response) => {
      response.writeHead(200, {'content-type': 'text/html', 'content-security-policy': kPolicy});
      response.end(readFileSync(this.page));
    });
    this.server.on('upgrade', (request, socket) => this.join(request, socket));
  }

  async listen() {
    await new Promise((resolve) => this.server.listen(0, '127.0.0.1', resolve));
    this.timers = [setInterval(() => this.sendFrame(), 16), setInterval(() => this.sendStatus(), 200)];
    return `http://127.0.0.1:${this.server.address().port}/`;
  }

  close() {
    this.timers.forEach(clearInterval);
    this.drop();
    this.server.close();
  }

  join(request, socket) {
    socket.on('error', () => {});
    if (!(request.headers['sec-websocket-protocol'] ?? '').split(', ').includes(`token.${this.token}`)) {
      socket.end('HTTP/1.1 401 Unauthorized\r\nConnection: close\r\n\r\n');
      return;
    }
    const key = createHash('sha1').update(
        `${request.headers['sec-websocket-key']}258EAFA5-E914-47DA-95CA-C5AB0DC85B11`).digest('base64');
    socket.write('HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n' +
                 `Sec-WebSocket-Accept: ${key}\r\nSec-WebSocket-Protocol: gaitd.v1\r\n\r\n`);
    this.viewers.add(socket);
    socket.on('close', () => this.viewers.delete(socket) && this.sendViewers());
    let rest = Buffer.alloc(0);
    socket.on('data', (bytes) => {
      let texts;
      [texts, rest] = unframed(Buffer.concat([rest, bytes]));
      for (const text of texts) this.take(socket, JSON.parse(text));
    });
    this.send({type: 'hello', role: this.role, version: 'test'}, [socket]);
    this.sendRobot([socket]);
    this.sendViewers();
  }

  send(message, to = this.viewers) {
    for (const socket of to) socket.write(framed(message instanceof Buffer ? message : JSON.stringify(message)));
  }

  sendRobot(to) {
    this.send(this.away ? {type: 'robot', connected: false, reason: 'the socket is gone'} :
        {type: 'robot', connected: true, ...this.robot}, to);
  }

  sendViewers() { this.send({type: 'viewers', viewers: this.viewers.size}); }

  sendFrame() {
    if (this.away) return;
    const time = performance.now() / 1000, values = this.row(time), frame = Buffer.alloc(16 + 4 * values.length);
    frame.writeDoubleLE(time, 0);
    frame.writeDoubleLE(Math.round(1000 * time), 8);
    values.forEach((value, i) => frame.writeFloatLE(value, 16 + 4 * i));
    this.send(frame);
  }

  sendStatus() {
    if (this.silent) this.send({type: 'status', status: null, silent: this.silent});
    else if (!this.away) this.send({type: 'status', status: this.status});
  }

  event(kind, text) {
    this.send({type: 'event', event: {tick: 1, time: performance.now() / 1000, kind, text: JSON.stringify(text)}});
  }

  setAway(away) {
    this.away = away;
    this.sendRobot();
  }

  drop() { for (const socket of this.viewers) socket.destroy(); }

  take(socket, request) {
    if (request.type === 'seen' && !this.slow) this.send(request, [socket]);
    if (!request.method) return;
    if (request.method === 'map.get') {  // asked for again and again, whatever the test does
      const {since = 0} = request.params ?? {}, {revision} = this.map;
      const result = since === revision ? {revision} : this.map;
      this.send({jsonrpc: '2.0', id: request.id, result}, [socket]);
      return;
    }
    this.asked.push(request);
    if (this.hangs && request.method !== 'estop') return;
    const answer = this.answer(request);
    const {error = undefined} = answer;
    this.send({jsonrpc: '2.0', id: request.id, ...(error ? {error} : {result: answer})}, [socket]);
  }

  // Requests of that method since the last call of `forget`.
  calls(method) { return this.asked.filter((one) => one.method === method).map(({params = {}}) => params); }

  forget() { this.asked = []; }
}
