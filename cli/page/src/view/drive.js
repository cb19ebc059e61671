// SPDX-License-Identifier: Apache-2.0
import {refused} from './refused.js';

const kPeriod = 100;   // ms between renewals
const kUnanswered = 3; // requests after which nothing more is sent until gaitd answers
const kZero = {forward: 0, lateral: 0, turn: 0};

export const isZero = ({forward, lateral, turn}) => !forward && !lateral && !turn;

// Drives the robot with what stick, keys and gamepad want, as long as one of them wants something.
// `call(method, params)`: to gaitd; `scale(wanted)`: shares from -1 to 1 as a velocity in m/s and rad/s;
// `mode()`: of the gait, at present; `congested()`; `tell(text, bad)`.
export class Drive extends EventTarget {
  constructor({call, scale, mode, congested, tell, session = Math.floor(Math.random() * 2 ** 53)}) {
    super();
    Object.assign(this, {call, scale, mode, congested, tell, session});
    this.wanted = new Map();  // by source
    this.unanswered = 0;
    this.notes = '';
  }

  // What `source` wants, in shares of the fastest; zero if it has been let go.
  want(source, wanted) {
    if (isZero(wanted)) this.wanted.delete(source);
    else this.wanted.set(source, wanted);
    if (!this.wanted.size) {
      this.blocked = false;
      if (this.driving) this.end();
    } else if (!this.driving && !this.blocked) {
      this.begin();
    }
  }

  release() {
    for (const source of [...this.wanted.keys()]) this.want(source, kZero);
  }

  get velocity() {
    const sum = {...kZero};
    for (const one of this.wanted.values()) for (const axis in sum) sum[axis] += one[axis];
    for (const axis in sum) sum[axis] = Math.max(-1, Math.min(1, sum[axis]));
    return this.scale(sum);
  }

  async begin() {
    const run = this.driving = {};
    this.changed();
    if (this.mode() === 'stand') {
      try {
        await this.call('mode', {mode: 'walk-straight'});
      } catch (error) {
        if (run === this.driving) this.fail('mode', error);
        return;
      }
      if (run !== this.driving) return;  // let go meanwhile
    }
    this.sent = false;
    this.timer = setInterval(() => this.renew(run), kPeriod);
    this.renew(run);
  }

  renew(run) {
    if (this.unanswered >= kUnanswered || this.congested()) return;
    this.request(run, this.renewal(this.velocity));
    this.changed();
  }

  renewal(velocity) {
    const renew = this.sent;
    this.sent = true;
    return {...velocity, session: this.session, renew};
  }

  async request(run, params, last = false) {
    ++this.unanswered;
    try {
      const {note} = await this.call('drive', params) ?? {};
      if (run === this.driving) this.say(note ?? '');
    } catch (error) {
      if (run === this.driving) this.fail('drive', error);
      else if (!last && !run.failed) this.tell(refused('drive', error), true);
      run.failed = true;
    } finally {
      --this.unanswered;
    }
  }

  // Not `stop`: that would also end what somebody else lets the robot do meanwhile.
  end() {
    const run = this.driving;
    clearInterval(this.timer);
    this.driving = undefined;
    if (this.sent) this.request(run, {session: this.session, end: true}, true);
    this.sent = false;
    this.say('');
    this.changed();
  }

  // Nothing more is sent until all let go: who is refused has to see it and to ask again.
  fail(what, error) {
    clearInterval(this.timer);
    this.driving.failed = true;
    this.driving = undefined;
    this.sent = false;
    this.blocked = true;
    this.tell(refused(what, error), true);
    this.say('');
    this.changed();
  }

  say(note) {
    if (note === this.notes) return;
    this.notes = note;
    this.changed();
  }

  changed() { this.dispatchEvent(new Event('change')); }
}
