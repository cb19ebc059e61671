// SPDX-License-Identifier: Apache-2.0
// Every run a dot, by a figure and the value of a setting, over the quantiles of all runs.
import {data, label, unit, varied} from './data.js';
import {lineColor} from '../shared/theme.js';
import {make} from '../shared/dom.js';
import {showRun} from './run_panel.js';
import {draw, hint, number, picture, scale, text, ticks} from './svg.js';

// Of the colours of lines those that nobody takes for the red of what failed.
const kCalm = [0, 2, 4, 7, 9, 10, 8, 13];

const kWidth = 860, kLeft = 190, kLine = 46;

// The same run stands at the same height each time; dots would hide each other on a line.
const spread = (run) => (run * 0.618034) % 1 - 0.5;

function plot(axis, f) {
  const boxes = axis.rows.map(({figures}) => figures[f]);
  const known = boxes.filter(Boolean);
  if (!known.length) return make('p', {className: 'quiet', textContent: 'Nothing was measured.'});
  const low = Math.min(...known.map((box) => box[0])), high = Math.max(...known.map((box) => box[6]));
  const x = scale(low, high, kLeft, kWidth - 24), height = kLine * axis.labels.length + 30;
  const svg = picture(kWidth, height, ...ticks(low, high, 8).flatMap((value) => [
    draw('line', {x1: x(value), x2: x(value), y1: 0, y2: height - 24, class: 'grid'}),
    text(x(value), height - 8, number(value), {class: 'tick', 'text-anchor': 'middle'})]));
  const dots = draw('g');
  for (const run of data.runs) {
    const value = run.figures[f];
    if (value === null) continue;
    const k = axis.place < 0 ? 0 : run.places[axis.place];
    const dot = draw('circle', {cx: x(value), cy: kLine * (k + 0.5) + spread(run.run) * 26, r: 3, 'data-run': run.run,
                                class: run.success ? 'run' : 'run bad'});
    if (run.success) dot.style.fill = lineColor(kCalm[k % kCalm.length]);
    dots.append(hint(dot, `run ${run.run}: ${number(value)}${run.fell ? ', fell' : ''}`));
  }
  dots.addEventListener('click', ({target}) => target.dataset.run && showRun(Number(target.dataset.run)));
  boxes.forEach((box, k) => {
    const y = kLine * (k + 0.5), name = axis.place < 0 ? 'all runs' : label(axis, k);
    svg.append(text(kLeft - 12, y + 4, name.length > 26 ? `…${name.slice(-25)}` : name, {'text-anchor': 'end'}));
    if (!box) return;
    svg.append(hint(draw('g', {class: 'box'},
        draw('line', {x1: x(box[1]), x2: x(box[5]), y1: y, y2: y}),
        draw('rect', {x: x(box[2]), y: y - 15, width: Math.max(1, x(box[4]) - x(box[2])), height: 30, rx: 2}),
        draw('line', {x1: x(box[3]), x2: x(box[3]), y1: y - 15, y2: y + 15, class: 'median'})),
        `median ${number(box[3])}, half of all between ${number(box[2])} and ${number(box[4])}, ` +
        `90 % between ${number(box[1])} and ${number(box[5])}`));
  });
  svg.append(dots);
  return svg;
}

// A selection among options [value, text].
function choice(name, options, act) {
  const select = make('select', {}, ...options.map(([value, words]) => make('option', {value, textContent: words})));
  select.addEventListener('change', act);
  return {element: make('label', {textContent: `${name} `}, select), select};
}

export function distributions() {
  const axes = varied.length ? varied : [{...data.axes[0], place: -1}];
  const place = make('div', {className: 'plot'});
  const show = () => place.replaceChildren(plot(axes[by.select.value], Number(figure.select.value)));
  const figure = choice('figure', data.figures.map((name, i) => [i, name + unit(name)]), show);
  const by = choice('by', axes.map(({key}, i) => [i, key]), show);
  figure.select.value = Math.max(0, data.figures.indexOf('icp_error_max'));
  show();
  return [make('p', {className: 'choices'}, figure.element, by.element), place,
          make('p', {className: 'quiet', textContent:
            'A dot is a run, red if it failed. Boxes hold half of all runs, lines 90 % of them.'})];
}
