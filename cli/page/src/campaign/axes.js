// SPDX-License-Identifier: Apache-2.0
// How success depends on each setting, on two together, and on what was drawn.
import {data, isNumeric, label, shortName, varied} from './data.js';
import {make} from '../shared/dom.js';
import {intervalWords, limitWords} from './rates.js';
import {showRun, showRuns} from './run_panel.js';
import {draw, hint, number, percent, picture, pressable, scale, text, ticks} from './svg.js';

const kWide = 560;
const at = (axis, k) => (run) => run.places[axis.place] === k;

function figure(title, ...children) {
  return make('figure', {}, make('figcaption', {textContent: title}), ...children);
}

const tell = (name, {successes, runs, low, high}) =>
    `${name}: ${successes}/${runs}, ${percent(successes / runs)} (${percent(low)} … ${percent(high)})`;

// Names below each other, for each the rate on its interval.
function names(axis) {
  const left = 190, line = 26, height = line * axis.labels.length + 30;
  const x = scale(0, 1, left, kWide - 20);
  const svg = picture(kWide, height, ...[0, 0.25, 0.5, 0.75, 1].flatMap((share) => [
    draw('line', {x1: x(share), x2: x(share), y1: 0, y2: height - 22, class: 'grid'}),
    text(x(share), height - 6, `${100 * share} %`, {class: 'tick', 'text-anchor': 'middle'})]));
  axis.rows.forEach((row, k) => {
    if (!row.runs) return;
    const y = line * k + 14, name = label(axis, k);
    const words = name.length > 26 ? `…${name.slice(-25)}` : name;
    svg.append(pressable(hint(draw('g', {},
        draw('rect', {x: 0, y: y - 12, width: kWide, height: 24, class: 'back'}),
        text(left - 12, y + 4, words, {'text-anchor': 'end'}),
        draw('line', {x1: x(row.low), x2: x(row.high), y1: y, y2: y, class: 'interval'}),
        draw('circle', {cx: x(row.successes / row.runs), cy: y, r: 5, class: 'dot'})), tell(name, row)),
        () => showRuns(`${axis.key} ${name}`, at(axis, k)), name));
  });
  return svg;
}

// Of rows {from, to, ...} along a line: rates with their intervals, and `more` below.
function curve(rows, open, more = 0) {
  const height = 210 + more, bottom = 180;
  const low = Math.min(...rows.map(({from}) => from)), high = Math.max(...rows.map(({to}) => to));
  const x = scale(low, high, 56, kWide - 24), y = scale(0, 1, bottom, 14);
  const svg = picture(kWide, height,
      ...[0, 0.25, 0.5, 0.75, 1].flatMap((share) => [
        draw('line', {x1: 50, x2: kWide - 16, y1: y(share), y2: y(share), class: 'grid'}),
        text(44, y(share) + 4, `${100 * share} %`, {class: 'tick', 'text-anchor': 'end'})]),
      ...ticks(low, high).map((value) =>
          text(x(value), height - 8, number(value), {class: 'tick', 'text-anchor': 'middle'})));
  const middle = ({from, to}) => x((from + to) / 2);
  svg.append(draw('polyline', {class: 'line', points: rows.map((row) =>
      `${middle(row)},${y(row.successes / row.runs)}`).join(' ')}));
  rows.forEach((row) => svg.append(pressable(hint(draw('g', {},
      draw('rect', {x: middle(row) - 8, y: 8, width: 16, height: bottom - 8, class: 'back'}),
      draw('line', {x1: middle(row), x2: middle(row), y1: y(row.low), y2: y(row.high), class: 'interval'}),
      draw('circle', {cx: middle(row), cy: y(row.successes / row.runs), r: 5, class: 'dot'})),
      tell(row.name, row)), () => open(row), row.name)));
  return {svg, x, bottom};
}

export function settings() {
  return varied.map((axis) => {
    if (!isNumeric(axis)) return figure(axis.key, names(axis));
    const rows = axis.rows.map((row, k) => ({...row, k, from: Number(axis.labels[k]), to: Number(axis.labels[k]),
                                             name: axis.labels[k]}))
        .filter((row) => row.runs).sort((a, b) => a.from - b.from);
    return figure(axis.key, curve(rows, (row) => showRuns(`${axis.key} ${row.name}`, at(axis, row.k))).svg);
  });
}

// From failure over neither to success.
const color = (share) => share < 0.5 ? `color-mix(in oklab, var(--mid) ${200 * share}%, var(--low))` :
    `color-mix(in oklab, var(--high) ${200 * share - 100}%, var(--mid))`;

function map({rows, columns, cells}) {
  // The longer side goes down.
  let a = {...data.axes[rows], place: rows}, b = {...data.axes[columns], place: columns};
  let of = (i, k) => cells[i * b.labels.length + k];
  if (b.labels.length > a.labels.length) {
    const width = b.labels.length;
    [a, b] = [b, a];
    of = (i, k) => cells[k * width + i];
  }
  const head = make('tr', {}, make('th'), ...b.labels.map((_, k) => make('th', {textContent: label(b, k)})));
  const body = a.labels.map((_, i) => make('tr', {}, make('th', {textContent: label(a, i)}),
      ...b.labels.map((_, k) => {
        const [successes, runs] = of(i, k);
        if (!runs) return make('td', {className: 'empty'});
        const cell = make('td', {textContent: Math.round(100 * successes / runs),
                                 title: `${label(a, i)}, ${label(b, k)}: ${successes}/${runs}`});
        cell.style.setProperty('--color', color(successes / runs));
        return pressable(cell, () => showRuns(`${label(a, i)}, ${label(b, k)}`,
            (run) => run.places[a.place] === i && run.places[b.place] === k));
      })));
  return figure(`${a.key} × ${b.key}, % success`, make('table', {className: 'map'}, head, ...body));
}

// Of a search: the least limit of all that differ in other things, darker the larger it is.
function limitMap(a, b) {
  const {from, to} = data.summary.search;
  const value = (one) => one.limit ?? one.low ?? one.high;
  const at = (axis, one) => axis.key === 'scenario' ? one.scenario : one.labels[axis.key];
  const head = make('tr', {}, make('th'), ...b.labels.map((_, k) => make('th', {textContent: label(b, k)})));
  const body = a.labels.map((_, i) => make('tr', {}, make('th', {textContent: label(a, i)}),
      ...b.labels.map((_, k) => {
        const [least] = data.summary.cells.filter((one) => one.finished && value(one) !== null &&
            at(a, one) === a.labels[i] && at(b, one) === b.labels[k]).sort((one, two) => (to < from ? -1 : 1) * (value(one) - value(two)));
        if (!least) return make('td', {className: 'empty'});
        const words = intervalWords(least);
        const cell = make('td', {title: `${label(a, i)}, ${label(b, k)}: ${limitWords(least)} (${words})`},
            limitWords(least), make('small', {textContent: least.limit === null ? '' : words}));
        cell.style.setProperty('--color', color((value(least) - from) / (to - from)));
        return pressable(cell, () => showRuns(`${label(a, i)}, ${label(b, k)}`,
            (run) => run.places[a.place] === i && run.places[b.place] === k));
      })));
  return figure(`${a.key} × ${b.key}, ${data.summary.search.key}`, make('table', {className: 'map'}, head, ...body));
}

export function limitMaps() {
  const axes = varied.filter(({key, labels}) => key !== data.summary.search.key && labels.length <= 60);
  return axes.flatMap((one, i) => axes.slice(i + 1).map((two) =>
      two.labels.length > one.labels.length ? limitMap(two, one) : limitMap(one, two)));
}

export const maps = () => data.maps.map(map);

// Pictures that gaitctl drew, by campaign files that say how.
export const polar = () => data.polar.map(({scenario, svg}) => figure(shortName(scenario),
    make('img', {className: 'polar', alt: `polar plot of ${shortName(scenario)}`,
                 src: `data:image/svg+xml,${encodeURIComponent(svg)}`})));

// Every run a mark below the rates, those that failed in a row of their own.
export function drawn() {
  return data.drawn.map(({key, draw: place, bins}) => {
    const rows = bins.map((bin) => ({...bin, name: `${number(bin.from)} … ${number(bin.to)}`}));
    const value = (run) => Number(run.drawn[place]);
    const {svg, x, bottom} = curve(rows, (row) => showRuns(`${key} ${row.name}`,
        (run) => value(run) >= row.from && value(run) <= row.to), 44);
    const marks = draw('g');
    for (const run of data.runs) {
      const y = bottom + (run.success ? 16 : 32);
      marks.append(draw('line', {x1: x(value(run)), x2: x(value(run)), y1: y - 6, y2: y + 6, 'data-run': run.run,
                                 class: run.success ? 'mark' : 'mark bad'}));
    }
    marks.addEventListener('click', ({target}) => target.dataset.run && showRun(Number(target.dataset.run)));
    svg.append(marks, text(44, bottom + 20, 'ok', {class: 'tick', 'text-anchor': 'end'}),
               text(44, bottom + 36, 'failed', {class: 'tick', 'text-anchor': 'end'}));
    return figure(key, svg);
  });
}
