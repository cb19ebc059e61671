// SPDX-License-Identifier: Apache-2.0

const kFirstWait = 250, kLongestWait = 5000;  // ms before it is tried again
const kSilence = 3000;     // ms after which a connection is given up: a status comes five times a second
const kCongested = 4096;   // bytes that wait to be sent
const kAnswer = 10;        // s
const kSeen = 4;           // frames between words that they have come: fewer than the server waits for

export class RpcError extends Error {
  constructor({code, message, data}) {
    super(message);
    this.code = code;
    this.data = data;
  }
}

const kNotSent = -1, kNoAnswer = -2;

// The WebSocket to `gaitctl view`, opened again whenever it ends. Messages are events named for their
// type, frames go to `onframe`. `state`: {kind: 'connecting' | 'open' | 'lost' | 'refused', text}.
export class Connection extends EventTarget {
  constructor(url, token, {Socket = WebSocket, answersAt = undefined} = {}) {
    super();
    Object.assign(this, {url, token, Socket, answersAt});
    this.waiting = new Map();  // requests without an answer, by id
    this.last_id = 0;
    this.took = 0;
    this.wait = kFirstWait;
    this.state = {kind: 'connecting', text: 'connecting'};
    this.onframe = () => {};
  }

  // With another token if one is given.
  open(token = this.token) {
    this.token = token;
    clearTimeout(this.timer);
    this.drop();
    if (!token) {
      this.set('refused', 'This address has no token. Open the one that `gaitctl view` printed, with ' +
          'all that follows the #.');
      return;
    }
    const socket = this.socket = new this.Socket(this.url, ['gaitd.v1', `token.${token}`]);
    socket.binaryType = 'arraybuffer';
    let opened = false;
    this.heard = Date.now();
    socket.onopen = () => {
      opened = true;
      this.heard = Date.now();
      this.wait = kFirstWait;
      this.set('open', '');
    };
    socket.onmessage = ({data}) => {
      this.heard = Date.now();
      if (typeof data === 'string') {
        this.take(data);
        return;
      }
      this.onframe(data);
      if (++this.frames % kSeen === 0) this.tellSeen();
    };
    socket.onclose = () => socket === this.socket && this.ended(opened);
    clearInterval(this.watch);
    this.watch = setInterval(() => {
      this.tellSeen();
      this.dispatchEvent(new Event('lag'));
      if (Date.now() < this.heard + kSilence) return;
      this.drop();
      this.ended(opened);
    }, 500);
  }

  // Somebody needs it now: without a connection the next try is made at once. One that is under way is left
  // alone: it may be long.
  hurry() {
    if (this.isOpen) return;
    this.wait = kFirstWait;
    if (!this.socket) this.open();
  }

  // Without waiting for the other side, which may be gone.
  drop() {
    const {socket} = this;
    Object.assign(this, {socket: undefined, frames: 0, asked: undefined, took: 0});
    clearInterval(this.watch);
    if (socket) socket.onopen = socket.onmessage = socket.onclose = null;
    socket?.close();
    for (const {reject} of this.waiting.values()) {
      reject(new RpcError({code: kNotSent, message: 'the connection ended before the answer'}));
    }
    this.waiting.clear();
  }

  async ended(opened) {
    this.drop();
    const {wait} = this;
    this.wait = Math.min(kLongestWait, 2 * wait);
    this.timer = setTimeout(() => this.open(), wait);
    if (opened) {
      this.set('lost', 'The connection to gaitctl view is lost; trying again.');
      return;
    }
    // A browser does not say why a WebSocket was refused; that pages are still served does.
    const serves = await this.answersAt?.().catch(() => false);
    if (this.state.kind === 'open') return;
    if (serves) {
      this.set('refused', 'gaitctl view refuses this page: its token is not, or no longer, the right one, ' +
          'or too many watch. Open the address that gaitctl view printed when it was started last.');
    } else {
      this.set('lost', 'gaitctl view does not answer; trying again. Has it been stopped?');
    }
  }

  set(kind, text) {
    this.state = {kind, text};
    this.dispatchEvent(new CustomEvent('state', {detail: this.state}));
  }

  take(text) {
    let message;
    try {
      message = JSON.parse(text);
    } catch {
      return;  // nothing that can be answered for
    }
    if (message.jsonrpc) this.answer(message);
    else if (message.type === 'seen') this.answerSeen(message.frames);
    else if (typeof message.type === 'string') {
      this.dispatchEvent(new CustomEvent(message.type, {detail: message}));
    }
  }

  answer({id, result, error}) {
    const request = this.waiting.get(id);
    if (!request) return;
    this.waiting.delete(id);
    clearTimeout(request.timer);
    if (error) request.reject(new RpcError(error));
    else request.resolve(result);
  }

  // Frames may wait on their way, in ssh say, where the server cannot see them: it leaves out others while too
  // many have not been seen. Its answer has waited behind all that was sent before.
  tellSeen() {
    const {frames} = this;
    if (this.send({type: 'seen', frames})) this.asked ??= {frames, at: Date.now()};
  }

  answerSeen(frames) {
    if (!(frames >= this.asked?.frames)) return;
    this.took = Date.now() - this.asked.at;
    this.asked = undefined;
  }

  // By how much what is shown may be old, s; 'lag' is dispatched twice a second.
  get lag() { return Math.max(this.took, this.asked ? Date.now() - this.asked.at : 0) / 1000; }

  get isOpen() { return this.state.kind === 'open' && this.socket !== undefined; }

  // Whether what is sent now would only wait behind what was sent before.
  get congested() { return (this.socket?.bufferedAmount ?? 0) > kCongested; }

  send(message) {
    if (!this.isOpen) return false;
    this.socket.send(JSON.stringify(message));
    return true;
  }

  // A request to gaitd. Rejected with an RpcError: refused, not sent, or not answered in time.
  call(method, params, seconds = kAnswer) {
    const id = ++this.last_id, request = {jsonrpc: '2.0', id, method, ...(params && {params})};
    return new Promise((resolve, reject) => {
      if (!this.send(request)) {
        reject(new RpcError({code: kNotSent, message: 'not sent: there is no connection'}));
        return;
      }
      const timer = setTimeout(() => {
        this.waiting.delete(id);
        reject(new RpcError({code: kNoAnswer, message: `no answer for ${seconds} s`}));
      }, 1000 * seconds);
      this.waiting.set(id, {resolve, reject, timer});
    });
  }
}
