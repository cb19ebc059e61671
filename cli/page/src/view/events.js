// SPDX-License-Identifier: Apache-2.0
import {$, say} from '../shared/dom.js';
import {isTwin, sentence, subject} from './event_list.js';

const kMost = 200;
const kNear = 4;  // lines among which one of the same is looked for

// The newest above; events of the same are one line that counts.
export class Events {
  constructor() {
    this.newest = [];  // lines: {about, count, row}
  }

  add(event) {
    if (isTwin(event)) return;
    const about = subject(event);
    let line = about && this.newest.find((one) => one.about === about);
    if (!line) {
      line = {about, count: 0, row: $('events').insertRow(0)};
      for (let i = 0; i < 3; ++i) line.row.insertCell();
      line.row.className = event.kind === 'fault' ? 'fail' : '';
      this.newest = [line, ...this.newest.slice(0, kNear - 1)];
      const {rows} = $('events');
      if (rows.length > kMost) rows[rows.length - 1].remove();
    }
    const [time, kind, text] = line.row.cells, times = ++line.count;
    say(time, `${event.time.toFixed(2)} s`);
    say(kind, event.kind);
    say(text, sentence(event) + (times > 1 ? ` (${times} times)` : ''));
  }
}
