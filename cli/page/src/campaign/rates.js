// SPDX-License-Identifier: Apache-2.0
// Tables of success rates with their intervals, and what a search has found.
import {data, shortName} from './data.js';
import {make} from '../shared/dom.js';
import {showRuns} from './run_panel.js';
import {draw, hint, number, percent, picture, pressable, scale} from './svg.js';

const kWidth = 150;

// The interval as a line, the rate as a dot on it.
export function intervalBar({successes, runs, low, high}) {
  const rate = successes / runs, x = (share) => 6 + share * (kWidth - 12);
  return hint(picture(kWidth, 16,
      draw('line', {x1: x(0), x2: x(1), y1: 8, y2: 8, class: 'track'}),
      draw('line', {x1: x(low), x2: x(high), y1: 8, y2: 8, class: 'interval'}),
      draw('circle', {cx: x(rate), cy: 8, r: 4, class: 'dot'})),
      `${percent(rate)}, with 95 % between ${percent(low)} and ${percent(high)}`);
}

const cell = (words, className = '') => make('td', {textContent: words, className});

function row(names, count, open) {
  const line = make('tr', {}, ...names.map((name) => cell(name)),
      cell(`${count.successes}/${count.runs}`, 'count'), cell(percent(count.successes / count.runs), 'count'),
      make('td', {}, intervalBar(count)),
      cell(`${percent(count.low)} … ${percent(count.high)}`, 'count quiet'),
      cell(count.falls || '', 'count'), cell(count.refusals || '', 'count'));
  return pressable(line, open, names.join(' '));
}

function table(names, rows) {
  return make('table', {className: 'rates'}, make('thead', {}, make('tr', {},
      ...names.map((name) => make('th', {textContent: name})), make('th', {textContent: 'success', className: 'count'}),
      make('th', {textContent: 'rate', className: 'count'}), make('th'),
      make('th', {textContent: '95 % interval', className: 'count'}), make('th', {textContent: 'falls', className: 'count'}),
      make('th', {textContent: 'refused', className: 'count'}))), make('tbody', {}, ...rows));
}

// Whether a run has these labels, by the key of the axis.
const has = (wanted) => (run) => data.axes.every((axis, i) =>
    !(axis.key in wanted) || axis.labels[run.places[i]] === wanted[axis.key]);

function groups() {
  return data.summary.groups.map(({by, rows}) => table(by, rows.map((one) => {
    const wanted = Object.fromEntries(by.map((key, i) => [key, one.labels[i]]));
    return row(one.labels.map(shortName), one, () => showRuns(one.labels.map(shortName).join(' '), has(wanted)));
  })));
}

function combinations() {
  const keys = data.axes.filter(({key, labels}) => key !== 'scenario' && labels.length > 1).map(({key}) => key);
  const rows = data.summary.cells.map((one) => {
    const names = [shortName(one.scenario), ...keys.map((key) => one.labels[key])];
    return row(names, one, () => showRuns(names.join(' '), has({...one.labels, scenario: one.scenario})));
  });
  return table(['scenario', ...keys], rows);
}

// The limit as a dot on its interval, which goes on to the edge where it is beyond what was tried.
function limitBar({limit, low, high}) {
  const {from, to} = data.summary.search;
  const x = scale(Math.min(from, to), Math.max(from, to), 6, kWidth - 6);
  const left = low === null ? 0 : x(low), right = high === null ? kWidth : x(high);
  return picture(kWidth, 16,
      draw('line', {x1: 6, x2: kWidth - 6, y1: 8, y2: 8, class: 'track'}),
      draw('line', {x1: left, x2: right, y1: 8, y2: 8, class: 'interval'}),
      ...(limit === null ? [] : [draw('circle', {cx: x(limit), cy: 8, r: 4, class: 'dot'})]));
}

const bound = ({low, high}) => low !== null ? `≥ ${number(low)}` : high !== null ? `≤ ${number(high)}` : 'not known';
export const limitWords = (one) => !one.finished ? 'not finished' : one.limit === null ? bound(one) : number(one.limit);
export const intervalWords = (one) => !one.finished ? '' : one.low === null || one.high === null ? bound(one) :
    `${number(one.low)} … ${number(one.high)}`;

function found() {
  const {key, rate} = data.summary.search;
  const keys = data.axes.filter(({key: name, labels}) => name !== 'scenario' && labels.length > 1 && name !== key)
      .map(({key: name}) => name);
  const head = (words) => make('th', {textContent: words, className: 'count'});
  return [make('p', {className: 'quiet', textContent: `${key} at which ${percent(rate)} of the runs succeed; each run has ` +
      'a seed of its own'}),
    make('table', {className: 'rates'}, make('thead', {}, make('tr', {},
      ...['scenario', ...keys].map((name) => make('th', {textContent: name})),
      head('limit'), make('th'), head('95 % interval'), head('runs'))),
      make('tbody', {}, ...data.summary.cells.map((one) => {
        const names = [shortName(one.scenario), ...keys.map((name) => one.labels[name])];
        return pressable(make('tr', {}, ...names.map((name) => cell(name)), cell(limitWords(one), 'count'),
            make('td', {}, one.finished ? limitBar(one) : ''), cell(intervalWords(one), 'count quiet'), cell(one.runs, 'count')),
            () => showRuns(names.join(' '), has({...one.labels, scenario: one.scenario})), names.join(' '));
      })))];
}

export function rates() {
  const {summary} = data;
  if (summary.search) return found();
  const all = combinations(), out = groups();
  const targets = summary.targets.map((target) => make('p', {}, make('span', {
    className: target.pass ? 'pass' : 'fail', textContent: target.pass ? 'reached ' : 'missed '}),
    `${Object.entries(target.where).map((pair) => pair.join('=')).join(' ')}: ${percent(target.success_rate)} of ` +
    `${target.runs} runs (${percent(target.low)} … ${percent(target.high)}), at least ${percent(target.rate)} asked for`));
  if (!out.length && summary.cells.length <= 60) return [all, ...targets];
  return [...out, ...targets, make('details', {open: !out.length},
      make('summary', {textContent: `Each of the ${summary.cells.length} combinations`}), all)];
}
