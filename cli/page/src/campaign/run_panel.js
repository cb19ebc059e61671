// SPDX-License-Identifier: Apache-2.0
// At the side: one run with what its log says and how to see it, or some to choose from.
import {data, label, logs, runs, unit} from './data.js';
import {make} from '../shared/dom.js';
import {number, pressable} from './svg.js';

const panel = document.getElementById('run');
const kListed = 60;

const state = (run) => run.problem ? 'not judged' : run.fell ? 'fell' : run.success ? 'ok' : 'failed';
const mark = (run) => make('span', {className: run.success ? 'pass' : 'fail', textContent: state(run)});

const settings = (run) => data.axes.map((axis, i) => [axis.key, label(axis, run.places[i])])
    .filter((_, i) => i === 0 || data.axes[i].labels.length > 1);

function table(rows) {
  return make('table', {}, ...rows.map(([name, value]) =>
      make('tr', {}, make('td', {textContent: name}), make('td', {textContent: value}))));
}

function command(words) {
  const copy = make('button', {textContent: 'Copy'});
  copy.addEventListener('click', async () => {
    try {
      await navigator.clipboard.writeText(words);
      copy.textContent = 'Copied';
    } catch {
      getSelection().selectAllChildren(code);
    }
  });
  const code = make('code', {textContent: words});
  return make('div', {className: 'command'}, code, copy);
}

function findings(log) {
  if (log.unreadable) return [make('p', {textContent: `Its log cannot be read: ${log.unreadable}`})];
  const out = [make('p', {textContent: log.ending ?? 'Neither a fall nor a fault.'})];
  const told = log.findings.filter(({severity}) => severity !== 'ok');
  if (told.length) {
    out.push(make('ol', {className: 'findings'}, ...told.map((one) => make('li', {},
        make('b', {textContent: one.time == null ? '' : `${one.time.toFixed(2)} s  `}), one.what,
        make('small', {textContent: one.advice})))));
  }
  return out;
}

function replay(run, log) {
  const file = `logs/${String(run.run).padStart(6, '0')}.mcap`;
  const out = [make('h3', {textContent: 'Replay'})];
  if (log?.replay) out.push(make('p', {}, make('a', {href: log.replay, textContent: 'Open the replay in 3-D'})));
  if (log && !log.replay) out.push(command(`gaitctl report ${file} -o run-${run.run}.html`));
  out.push(make('p', {className: 'quiet', textContent: 'The same run again, to the bit, from the folder of the campaign:'}),
           command(run.replay));
  return out;
}

export function showRun(run_number) {
  const run = runs.get(run_number), log = logs.get(run_number);
  const measured = data.figures.map((name, i) => [name + unit(name), run.figures[i]])
      .filter(([, value]) => value !== null).map(([name, value]) => [name, number(value)]);
  panel.replaceChildren(
      make('h2', {}, `Run ${run.run}  `, mark(run)),
      table([...settings(run), ['seed', run.seed],
             ...(run.failed ? [['not held', run.failed]] : []), ...(run.problem ? [['problem', run.problem]] : [])]),
      make('h3', {textContent: 'Doctor'}),
      ...(log ? findings(log) : [make('p', {className: 'quiet', textContent:
          'No log of this run was kept. Play it again, below, and ask gaitctl doctor.'})]),
      ...replay(run, log),
      make('h3', {textContent: 'Figures'}), table(measured),
      ...(data.draws.length ? [make('h3', {textContent: 'Drawn'}),
                               table(data.draws.map((key, i) => [key, run.drawn[i]]))] : []));
  history.replaceState(null, '', `#run=${run.run}`);
  document.querySelectorAll('.chosen').forEach((one) => one.classList.remove('chosen'));
  document.querySelectorAll(`[data-run="${run.run}"]`).forEach((one) => one.classList.add('chosen'));
}

// Runs for which `meant` holds; a single one is shown itself.
export function showRuns(title, meant) {
  const found = data.runs.filter(meant).sort((a, b) => a.success - b.success);
  if (found.length === 1) return showRun(found[0].run);
  const list = make('ol', {className: 'runs'}, ...found.slice(0, kListed).map((run) => {
    const seen = logs.get(run.run)?.first?.what ?? run.problem ?? '';
    const item = make('li', {}, make('b', {textContent: `Run ${run.run}`}), ` seed ${run.seed} `, mark(run),
                      make('small', {textContent: seen || run.failed}));
    return pressable(item, () => showRun(run.run));
  }));
  panel.replaceChildren(make('h2', {textContent: title}),
      make('p', {className: 'quiet', textContent: found.length > kListed ?
          `${kListed} of the ${found.length} runs on this page, those that failed first` :
          `${found.length} runs on this page`}), list);
}

export function startPanel() {
  const asked = Number(/^#run=(\d+)$/.exec(location.hash)?.[1]);
  const first = asked && runs.has(asked) ? asked : data.summary.worst[0]?.run;
  if (runs.has(first)) showRun(first);
}
