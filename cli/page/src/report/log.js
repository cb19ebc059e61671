// SPDX-License-Identifier: Apache-2.0
import {appendPlan} from '../shared/plan.js';
import {Signals} from '../shared/signals.js';

// What gaitctl put into the page: everything of a log that is shown.
export class Log extends Signals {
  constructor(document_) {
    super();
    Object.assign(this, document_);  // title, metadata, verdict, events, signals, rows, urdf, robot
    this.setSignals(document_.signals);
    this.columns = new Map();  // those that were asked for
    this.time = this.column('time');
    // Beside what the robot did: {time, push: link, force, point, duration}.
    this.pushes = this.events.filter(({text}) => text?.push && text.force)
        .map(({time, text}) => ({time, ...text}));
    this.plans = [];
    for (const event of this.events) appendPlan(this.plans, event);
    this.ground = JSON.parse(this.metadata.map ?? 'null');  // as it was known at the end
    this.legs = JSON.parse(this.metadata.legs ?? '{}');
    this.efforts = Object.fromEntries(JSON.parse(this.metadata.joints ?? '[]')
        .map((joint) => [joint.name, joint.effort_limit]));
    this.all = [this, ...(this.others ?? []).map((other) => new Log(other))];
  }

  column(name) {
    let column = this.columns.get(name);
    if (column === undefined && this.has(name)) {
      const text = atob(this.signals[this.index.get(name)].values);
      const bytes = new Uint8Array(text.length);
      for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
      column = new Float32Array(bytes.buffer);
      this.columns.set(name, column);
    }
    return column;
  }
}
