// SPDX-License-Identifier: Apache-2.0
import '../shared/base.css';
import './campaign.css';
import {drawn, limitMaps, maps, polar, settings} from './axes.js';
import {comparisons} from './comparisons.js';
import {data} from './data.js';
import {distributions} from './distributions.js';
import {rates} from './rates.js';
import {showRun, startPanel} from './run_panel.js';
import {$, make} from '../shared/dom.js';

const {summary} = data;
document.title = `${summary.campaign} – gaitd campaign`;
$('title').textContent = summary.campaign;
$('verdict').append(make('span', {className: summary.pass ? 'pass' : 'fail', textContent: summary.pass ? 'passed' : 'not passed'}),
    ` ${summary.successes.toLocaleString('en')} of ${summary.finished.toLocaleString('en')} runs succeeded` +
    (summary.finished < summary.runs ? `, of ${summary.runs.toLocaleString('en')} that are asked for` : ''));

const grid = (children) => children.length ? [make('div', {className: 'figures'}, ...children)] : [];
const searched = Boolean(summary.search);
// A search plays what is near the limit, so that shares of its runs say nothing.
const sections = [
  ['rates', searched ? 'Limits' : 'Rates', rates()],
  ['polar', 'Polar plots', grid(polar())],
  ['settings', 'By setting', searched ? [] : grid(settings())],
  ['maps', 'Maps', grid(searched ? limitMaps() : maps())],
  ['drawn', 'By what was drawn', searched ? [] : grid(drawn())],
  ['distributions', 'Distributions', distributions()],
  ['comparisons', 'Variants on the same seeds', comparisons()],
].filter(([, , content]) => content.length);
for (const [id, title, content] of sections) {
  document.querySelector('main').append(make('section', {id}, make('h2', {textContent: title}), ...content));
  const link = make('a', {href: `#${id}`, textContent: title});
  link.addEventListener('click', (event) => {
    event.preventDefault();  // the fragment is that of the run
    $(id).scrollIntoView({behavior: 'smooth'});
  });
  $('sections').append(link);
}
if (data.runs.length < summary.finished) {
  document.querySelector('main').append(make('p', {className: 'quiet', textContent:
      `Dots and lists show ${data.runs.length} of ${summary.finished} runs, those that failed first; rates, boxes and ` +
      'comparisons count all of them.'}));
}
startPanel();
addEventListener('hashchange', startPanel);
window.gaitd = {data, showRun};  // for the console of the browser
