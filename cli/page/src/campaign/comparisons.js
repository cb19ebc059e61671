// SPDX-License-Identifier: Apache-2.0
// Two variants on the same seeds.
import {data, unit} from './data.js';
import {make} from '../shared/dom.js';
import {showRuns} from './run_panel.js';
import {number, pressable} from './svg.js';

const kShown = 3;  // comparisons of one setting that stand open

const cell = (words, className = '') => make('td', {textContent: words, className});
const chance = (p) => p < 0.001 ? '< 0.001' : p.toFixed(3);

// How many seeds those are: all seeds of the campaign make `pairs`.
function more({more}, pairs) {
  if (more === 0) return cell('decided', 'pass');
  if (more === null) return cell('no difference seen', 'quiet');
  const needed = Math.ceil(more / (pairs / data.seeds));
  return cell(`${more.toLocaleString('en')} more pairs, ${needed.toLocaleString('en')} more seeds`);
}

const head = (...names) => make('thead', {}, make('tr', {}, ...names.map((name, i) =>
    make('th', {textContent: name, className: i ? 'count' : ''}))));

function comparison(one) {
  const place = data.axes.findIndex(({key}) => key === one.key), axis = data.axes[place];
  const only = (mine, other, what) => {
    const bad = (run) => what === 'falls' ? run.fell : !run.success;
    const name = (run) => `${run.seed} ${run.places.filter((_, i) => i !== place).join()}`;
    const of = (label) => data.runs.filter((run) => axis.labels[run.places[place]] === label);
    const held = new Set(of(other).filter((run) => !bad(run)).map(name));
    return showRuns(`${what} of ${mine} alone`, (run) =>
        axis.labels[run.places[place]] === mine && bad(run) && held.has(name(run)));
  };
  const shares = one.shares.map((share) => make('tr', {}, cell(share.what), cell(share.both, 'count'),
      pressable(cell(share.only_first, 'count'), () => only(one.first, one.second, share.what)),
      pressable(cell(share.only_second, 'count'), () => only(one.second, one.first, share.what)),
      cell(chance(share.p), 'count'), more(share, one.pairs)));
  const figures = one.figures.map((figure) => make('tr', {}, cell(figure.figure + unit(figure.figure)),
      cell(figure.pairs, 'count'), cell(`${figure.mean > 0 ? '+' : ''}${number(figure.mean)}`, 'count'),
      cell(`${number(figure.low)} … ${number(figure.high)}`, 'count'), more(figure, figure.pairs)));
  return make('figure', {},
      make('figcaption', {}, `${one.key}: `, make('b', {textContent: one.first}), ' against ',
           make('b', {textContent: one.second}), ` on ${one.pairs} pairs`),
      make('table', {className: 'rates'}, head('', 'both', `only ${one.first}`, `only ${one.second}`, 'p (McNemar)', ''),
           make('tbody', {}, ...shares)),
      one.figures.length ? make('table', {className: 'rates'},
          head(`${one.second} − ${one.first}`, 'pairs', 'mean', '95 % interval', ''),
          make('tbody', {}, ...figures)) : '');
}

export function comparisons() {
  if (!data.comparisons.length) return [];
  const byKey = new Map();
  for (const one of data.comparisons) byKey.set(one.key, [...(byKey.get(one.key) ?? []), one]);
  const tests = data.comparisons.reduce((sum, {shares, figures}) => sum + shares.length + figures.length, 0);
  return [make('p', {className: 'quiet', textContent:
            'Each pair is two runs that differ in this setting alone: scenario, seed, draws and all else are the same. ' +
            'p is the exact chance of so uneven a split where both fare alike. Means are of pairs in which neither ' +
            'fell, with intervals by bootstrap, of at most ten pairs by Student. What is not decided at 5 % says how many more pairs would decide it, ' +
            'with a power of 80 %, if the difference is what was seen. ' +
            `Of ${tests} comparisons ${Math.max(1, Math.round(0.05 * tests))} would seem decided by chance.`}),
          ...[...byKey].flatMap(([key, those]) => those.length <= kShown ? those.map(comparison) :
              [make('details', {}, make('summary', {textContent: `${those.length} comparisons of ${key}`}),
                    ...those.map(comparison))])];
}
