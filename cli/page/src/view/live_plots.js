// SPDX-License-Identifier: Apache-2.0
import {panels, timePlot} from '../shared/plots.js';
import {make} from '../shared/dom.js';
import {roundRange} from './round_range.js';

const kHeight = 165;
const kPeriod = 100;  // ms between drawings of a plot

// Of a robot that stands still nobody wants to see the micrometres: the least that a plot shows.
const kLeast = {m: 0.05, rad: 0.1, '1': 0.1, N: 100, 'm, s': 0.05, 'µs': 100};

// Plots of the last seconds that scroll. `draw(now)` with each frame of the robot draws one of them at
// most, of those in view, so that the robot does not wait for all.
export class LivePlots {
  constructor(live, element, seconds) {
    Object.assign(this, {live, element, seconds});
    this.boxes = [];
    this.watcher = new IntersectionObserver((entries) => {
      for (const {target, isIntersecting} of entries) {
        this.boxes.find(({box}) => box === target).inView = isIntersecting;
      }
    });
    this.sizes = new ResizeObserver(() => this.resize());
    this.sizes.observe(element);
    for (const panel of panels(live)) {
      const box = make('div', {id: `plot-${panel.id}`},
                       make('h2', {}, panel.title, make('small', {textContent: panel.unit === '1' ? '' : ` ${panel.unit}`})));
      box.style.minHeight = `${kHeight + 20}px`;  // until it is made
      element.append(box);
      this.boxes.push({panel: {...panel, unit: undefined}, box, drawn: 0, least: kLeast[panel.unit] ?? 0});
      this.watcher.observe(box);
    }
  }

  get plots() { return this.boxes.filter(({plot}) => plot).map(({panel: {id}, plot}) => ({id, plot})); }

  get width() { return Math.max(280, this.element.clientWidth - 4); }

  resize() {
    if (!this.element.clientWidth) return;  // in a tab that is not shown
    for (const {plot} of this.boxes) {
      if (plot && plot.width !== this.width) plot.setSize({width: this.width, height: kHeight});
    }
  }

  draw(now) {
    if (this.live.rows < 2) return;
    const due = this.boxes.filter(({inView, drawn}) => inView && now >= drawn + kPeriod)
        .sort((a, b) => a.drawn - b.drawn)[0];
    if (!due) return;
    due.drawn = now;
    if (due.plot) due.plot.refresh();
    else due.plot = this.makePlot(due);
    // In the legend the newest values, unless the mouse asks for others.
    if (due.plot.cursor.left < 0) due.plot.setLegend({idx: this.live.rows - 1}, false);
  }

  makePlot({panel, box, least}) {
    const range = () => [this.live.end - this.seconds(), this.live.end];
    return timePlot(this.live, panel, undefined, box, this.width, kHeight, {
      x: {range}, y: {range: (_, low, high) => roundRange(low, high, least)}, cursor: {drag: {x: false, y: false}}, axis: {label: undefined, size: 26},
    });
  }

  remove() {
    this.watcher.disconnect();
    this.sizes.disconnect();
    for (const {plot, box} of this.boxes) {
      plot?.destroy();
      box.remove();
    }
  }
}
