// SPDX-License-Identifier: Apache-2.0
// What gaitctl put into the page: everything of a log that is shown.

export class Log {
  constructor(document_) {
    Object.assign(this, document_);  // title, metadata, verdict, events, signals, rows, urdf, robot
    this.index = new Map(this.signals.map((signal, i) => [signal.name, i]));
    this.columns = new Map();  // those that were asked for
    this.time = this.column('time');
    // Beside what the robot did: {time, push: link, force, point, duration}.
    this.pushes = this.events.filter(({text}) => text?.push && text.force)
        .map(({time, text}) => ({time, ...text}));
    this.all = [this, ...(this.others ?? []).map((other) => new Log(other))];
  }

  get start() { return this.time[0]; }
  get end() { return this.time[this.rows - 1]; }

  has(name) { return this.index.has(name); }

  // One value per row; undefined if the log does not have it.
  column(name) {
    let column = this.columns.get(name);
    if (column === undefined && this.index.has(name)) {
      const text = atob(this.signals[this.index.get(name)].values);
      const bytes = new Uint8Array(text.length);
      for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
      column = new Float32Array(bytes.buffer);
      this.columns.set(name, column);
    }
    return column;
  }

  value(name, row) {
    const column = this.column(name);
    return column === undefined ? NaN : column[row];
  }

  // An enumeration as its word.
  word(name, row) {
    const i = this.index.get(name);
    return i === undefined ? '' : this.signals[i].words?.[this.value(name, row)] ?? '';
  }

  // All words of an enumeration.
  words(name) { return this.signals[this.index.get(name)]?.words ?? []; }

  point(prefix, row) {
    return ['x', 'y', 'z'].map((axis) => this.value(`${prefix}/${axis}`, row));
  }

  // The last row that is not later.
  row(time) {
    let low = 0, high = this.rows - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.time[middle] <= time) low = middle; else high = middle - 1;
    }
    return low;
  }

  // A signal at the times of another log; NaN where there is none of it.
  columnAt(name, times) {
    const column = this.column(name), {start, end} = this;
    if (times === this.time) return column;
    return Float32Array.from(times, (time) =>
        time < start || time > end ? NaN : column[this.row(time)]);
  }

  // [from, to] in s of every stretch in which an enumeration has that word or a boolean is true.
  spans(name, word) {
    const column = this.column(name);
    if (column === undefined) return [];
    const wanted = word === undefined ? 1 : this.signals[this.index.get(name)].words.indexOf(word);
    const spans = [];
    for (let row = 0; row < this.rows; ++row) {
      if (column[row] !== wanted) continue;
      if (row > 0 && column[row - 1] === wanted) spans.at(-1)[1] = this.time[row];
      else spans.push([this.time[row], this.time[row]]);
    }
    return spans;
  }
}
