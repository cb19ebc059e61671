// SPDX-License-Identifier: Apache-2.0
import {obstacle} from './rights.js';

// What the page knows beside the signals. Dispatches 'change' when rights may have changed, and 'status'
// for each status.
export class State extends EventTarget {
  constructor(connection) {
    super();
    Object.assign(this, {online: false, connected: false, role: 'observe', simulation: false,
                         viewers: undefined, reason: '', status: undefined, silent: 0});
    const on = (type, change) => connection.addEventListener(type, ({detail}) => {
      change(detail);
      this.dispatchEvent(new Event('change'));
    });
    on('state', ({kind}) => {
      this.online = kind === 'open';
      if (!this.online) this.connected = false;
    });
    on('hello', ({role, version, viewers}) => Object.assign(this, {role, version, viewers}));
    on('robot', ({connected, reason = '', simulation = false, name = this.name}) => {
      Object.assign(this, {connected, reason, simulation, name});
    });
    connection.addEventListener('status', ({detail: {status, silent = 0}}) => {
      const changed = status?.state !== this.status?.state;
      Object.assign(this, {status, silent});  // s since gaitd answered: the status is how it was then
      if (changed) this.dispatchEvent(new Event('change'));
      this.dispatchEvent(new Event('status'));
    });
  }

  obstacle(method, name) { return obstacle(method, this, name); }
}
