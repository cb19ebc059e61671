// SPDX-License-Identifier: Apache-2.0
import {$, make, say} from './dom.js';
import {sentence, subject} from './event_list.js';

const kMost = 200;

// The newest above; a run of the same is one line that counts.
export class Events {
  add(event) {
    const about = subject(event);
    if (about !== undefined && about === this.about) {
      ++this.count;
    } else {
      this.about = about;
      this.count = 1;
      this.row = $('events').insertRow(0);
      for (let i = 0; i < 3; ++i) this.row.insertCell();
      this.row.className = event.kind === 'fault' ? 'fail' : '';
      const rows = $('events').rows;
      if (rows.length > kMost) rows[rows.length - 1].remove();
    }
    const [time, kind, text] = this.row.cells;
    say(time, `${event.time.toFixed(2)} s`);
    say(kind, event.kind);
    say(text, sentence(event) + (this.count > 1 ? ` (${this.count} times)` : ''));
  }
}
