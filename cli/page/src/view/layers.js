// SPDX-License-Identifier: Apache-2.0
import {$, enable, make, say} from '../shared/dom.js';

const kSwap = 60;  // s: a swap is watched for a while before it is answered
const time = (value) => typeof value === 'number' ? value.toFixed(0) : '–';
const kTimes = [['time_us', 'now'], ['longest_us', 'longest'], ['p99_us', '99 %'], ['max_us', 'max'],
                ['budget_us', 'budget']];

// What a swap did, as text.
const steps = (result) => (result?.steps ?? []).map(({step, tick, difference}) =>
    `${step} at tick ${tick}${typeof difference === 'number' ? `, difference ${difference.toPrecision(3)}` : ''}`)
    .join('; ');

// Layers: their times, their variants, and how to exchange them.
export class Layers {
  constructor(state, call) {
    Object.assign(this, {state, call});
    this.rows = new Map();  // by layer
    state.addEventListener('status', () => this.showTimes());
    state.addEventListener('change', () => this.enable());
  }

  // Of another gaitd, or after a swap.
  async load() {
    let plugins;
    try {
      ({plugins} = await this.call('plugin.list'));
    } catch (error) {
      say($('layers-note'), `plugin.list: ${error.message}`);
      return;
    }
    say($('layers-note'), '');
    plugins = plugins.filter(({layer}) => layer !== 'backend');  // which is chosen when gaitd starts
    for (const layer of new Set(plugins.map((one) => one.layer))) {
      this.fill(this.row(layer), plugins.filter((one) => one.layer === layer));
    }
    $('refused').replaceChildren(...plugins.filter(({refused}) => refused).map(({layer, variant, refused}) =>
        make('p', {className: 'small', textContent: `${layer}/${variant} was refused: ${refused}`})));
    this.enable();
  }

  row(layer) {
    if (this.rows.has(layer)) return this.rows.get(layer);
    const row = {layer, variant: make('b'), choice: make('select', {title: `variants of ${layer}`}),
                 swap: make('button', {textContent: 'Swap'}), back: make('button', {textContent: 'Roll back'}),
                 said: make('p', {className: 'small'}), times: new Map()};
    const times = make('div', {className: 'times'}, ...kTimes.map(([key, label]) => {
      row.times.set(key, make('output', {textContent: '–'}));
      return make('span', {}, `${label} `, row.times.get(key));
    }), make('span', {textContent: 'µs'}));
    row.swap.addEventListener('click', () => this.exchange(row, 'plugin.swap', {layer, to: row.choice.value}));
    row.back.addEventListener('click', () => this.exchange(row, 'plugin.rollback', {layer}));
    row.choice.addEventListener('change', () => this.enable());
    $('layers').append(make('section', {className: 'layer'},
        make('h3', {}, layer, ' ', row.variant), times,
        make('div', {className: 'row'}, row.choice, row.swap, row.back), row.said));
    this.rows.set(layer, row);
    return row;
  }

  fill(row, plugins) {
    const usable = plugins.filter(({refused}) => !refused);
    row.active = usable.find(({active}) => active)?.variant;
    row.choice.replaceChildren(...usable.map(({variant}) => make('option', {textContent: variant})));
    const other = usable.find(({active}) => !active)?.variant;
    if (other ?? row.active) row.choice.value = other ?? row.active;
    say(row.variant, row.active ?? '');
  }

  enable() {
    for (const row of this.rows.values()) {
      const busy = row.busy ? 'an exchange of this layer is not over' : '';
      const same = row.choice.value === row.active ? 'in use already' : '';
      enable(row.swap, this.state.obstacle('plugin.swap') || busy || same, 'Exchange it while the robot walks');
      enable(row.back, this.state.obstacle('plugin.rollback') || busy, 'Back to the one before the last swap');
      row.choice.disabled = Boolean(this.state.obstacle('plugin.swap'));
    }
  }

  async exchange(row, method, params) {
    row.busy = true;
    this.enable();
    row.said.className = 'small busy';
    say(row.said, params.to ? `${params.to}: loads, and runs in the shadow …` : 'rolls back …');
    try {
      const result = await this.call(method, params, kSwap);
      row.said.className = 'small pass';
      say(row.said, [result?.note, steps(result)].filter(Boolean).join('. '));
    } catch (error) {
      row.said.className = 'small fail';
      say(row.said, error.message);
    }
    row.busy = false;
    this.enable();
    await this.load();
    this.onswap?.();
  }

  showTimes() {
    if (!$('layers').offsetParent) return;  // in a tab that is not shown
    for (const layer of this.state.status?.layers ?? []) {
      const row = this.row(layer.layer);
      say(row.variant, layer.variant ?? '');
      for (const [key, output] of row.times) {
        say(output, time(layer[key]));
        output.className = key !== 'budget_us' && layer[key] > layer.budget_us ? 'fail' : '';
      }
    }
  }
}
