// SPDX-License-Identifier: Apache-2.0
import {appendPlan} from '../shared/plan.js';
import {Signals} from '../shared/signals.js';

const kSeconds = 30, kRate = 100;  // that are kept, frames/s at most
const kOfOnePush = 0.25;  // s between parts of it: who drags a link sends many

// What a running robot did in the last seconds. Every column is twice as long as what is kept, so that
// rows are appended in place and moved to the front only once in a while, and a part of it is a column
// of a log.
export class Live extends Signals {
  constructor({signals, robot, urdf, world, name}, capacity = kSeconds * kRate) {
    super();
    Object.assign(this, {robot, urdf, world, name});
    this.setSignals(signals);
    this.capacity = capacity;
    this.times = new Float64Array(2 * capacity);
    this.values = signals.map(() => new Float32Array(2 * capacity));
    this.all = [this];
    this.legs = robot?.legs ?? {};
    this.version = 0;  // changes with each row
    this.clear();
  }

  clear() {
    this.first = this.rows = 0;
    this.pushes = [];
    this.plans = [];
    this.time = this.times.subarray(0, 0);
  }

  column(name) {
    if (name === 'time') return this.time;
    return this.values[this.index.get(name)]?.subarray(this.first, this.first + this.rows);
  }

  value(name, row) {
    const column = this.values[this.index.get(name)];
    return column === undefined ? NaN : column[this.first + row];
  }

  newest(name) { return this.rows ? this.value(name, this.rows - 1) : NaN; }

  // A binary message: time, tick, then a value of each signal. False if it is none of these signals.
  append(buffer) {
    if (buffer.byteLength !== 16 + 4 * this.signals.length) return false;
    const view = new DataView(buffer), time = view.getFloat64(0, true);
    if (this.rows && time < this.end) this.clear();  // the clock began again
    if (this.rows === this.capacity) {
      ++this.first;
      --this.rows;
    }
    if (this.first + this.rows === 2 * this.capacity) {
      for (const column of [this.times, ...this.values]) column.copyWithin(0, this.first);
      this.first = 0;
    }
    const at = this.first + this.rows++;
    this.times[at] = time;
    for (let i = 0; i < this.values.length; ++i) this.values[i][at] = view.getFloat32(16 + 4 * i, true);
    this.time = this.times.subarray(this.first, this.first + this.rows);
    this.tick = view.getFloat64(8, true);
    ++this.version;
    return true;
  }

  // Of an event, if it is a command of footsteps: the newest ones count.
  appendPlan(event) {
    appendPlan(this.plans, event);
    if (this.plans.length > 1) this.plans = this.plans.slice(-1);
  }

  // Of an event, if it is a push.
  appendPush({time, text}) {
    if (!text?.push || !text.force) return;
    const last = this.pushes.at(-1);
    if (last?.push === text.push && time <= last.time + last.duration + kOfOnePush) {
      Object.assign(last, text, {duration: time + text.duration - last.time});
      return;
    }
    this.pushes = this.pushes.filter((one) => one.time + one.duration >= this.start);
    this.pushes.push({time, ...text});
  }
}
