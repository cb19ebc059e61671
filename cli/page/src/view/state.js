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
    on('hello', ({role, version}) => Object.assign(this, {role, version}));
    on('viewers', ({viewers}) => { this.viewers = viewers; });
    on('robot', ({connected, reason = '', simulation = false, name = this.name}) => {
      Object.assign(this, {connected, reason, simulation, name});
    });
    connection.addEventListener('status', ({detail: {status, silent = 0}}) => {
      // s since gaitd answered; without a status the last one is shown, as old as that.
      const changed = (status && status.state !== this.status?.state) || silent > 1 !== this.silent > 1;
      this.status = status ?? this.status;
      this.silent = silent;
      if (changed) this.dispatchEvent(new Event('change'));
      this.dispatchEvent(new Event('status'));
    });
  }

  obstacle(method, name) { return obstacle(method, this, name); }
}
