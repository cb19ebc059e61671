// SPDX-License-Identifier: Apache-2.0
// Signals over time, wherever they come from: a log or a robot that is running now.
//
// Who extends it has `signals` ({name, unit, words} each), `rows`, `time` (s, of each row) and
// `column(name)`, one value per row; undefined if there is no such signal.
export class Signals {
  setSignals(signals) {
    this.signals = signals;
    this.index = new Map(signals.map((signal, i) => [signal.name, i]));
  }

  get start() { return this.time[0]; }
  get end() { return this.time[this.rows - 1]; }

  has(name) { return this.index.has(name); }

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
    const wanted = word === undefined ? 1 : this.words(name).indexOf(word);
    const spans = [];
    for (let row = 0; row < this.rows; ++row) {
      if (column[row] !== wanted) continue;
      if (row > 0 && column[row - 1] === wanted) spans.at(-1)[1] = this.time[row];
      else spans.push([this.time[row], this.time[row]]);
    }
    return spans;
  }
}
