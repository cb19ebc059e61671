// SPDX-License-Identifier: Apache-2.0
import {$, make, say} from '../shared/dom.js';
import {grouped, isChanged, shown, stepOf} from './parameter_list.js';
import {tell} from './toast.js';

const kTyping = 200;  // ms after a letter of the filter

// All parameters, each with what changes it. Values are those that gaitd says, never those that were
// asked for.
export class Parameters {
  constructor(state, call) {
    Object.assign(this, {state, call, list: [], rows: new Map()});
    state.addEventListener('change', () => this.enable());
    $('filter').addEventListener('input', () => {
      clearTimeout(this.timer);
      this.timer = setTimeout(() => this.show(), kTyping);
    });
    $('only-changed').addEventListener('change', () => this.show());
  }

  async load() {
    try {
      this.list = (await this.call('param.list')).parameters;
    } catch (error) {
      say($('parameters-note'), `param.list: ${error.message}`);
      return;
    }
    this.show();
  }

  show() {
    const changed = $('only-changed').checked;
    const scopes = grouped(this.list.filter((one) => !changed || isChanged(one)), $('filter').value);
    const searched = changed || $('filter').value.trim() !== '';
    const open = new Set([...$('parameters').querySelectorAll('details[open]')].map(({id}) => id));
    this.rows.clear();
    $('parameters').replaceChildren(...scopes.map(([scope, list]) => {
      const count = make('small', {textContent: ` ${list.length}`});
      const box = make('details', {id: `scope-${scope}`, open: searched || open.has(`scope-${scope}`)},
                       make('summary', {}, scope, count));
      // Rows are made when they are seen: there are hundreds.
      const fill = () => {
        if (!box.open || box.childElementCount > 1) return;
        box.append(...list.map((one) => this.row(one)));
        this.enable();
      };
      box.addEventListener('toggle', fill);
      fill();
      return box;
    }));
    const all = this.list.length, there = scopes.reduce((sum, [, list]) => sum + list.length, 0);
    const other = this.list.filter(isChanged).length;
    say($('parameters-note'), `${there} of ${all}, ${other} not at their default`);
  }

  row(parameter) {
    const {name, type, unit, description, min, max, effect, variant} = parameter;
    const row = {parameter, inputs: []};
    const box = row.box = make('div', {className: 'parameter'});
    const head = make('div', {}, make('code', {textContent: name}), variant ? ` of ${variant}` : '');
    const controls = make('div', {className: 'row'});
    row.obstacle = make('small');
    if (type === 'boolean') {
      row.toggle = make('input', {type: 'checkbox', title: name});
      row.toggle.addEventListener('change', () => this.set(row, row.toggle.checked));
      row.inputs.push(row.toggle);
    } else {
      const step = stepOf(parameter);
      row.slider = make('input', {type: 'range', min, max, step, title: name});
      row.number = make('input', {type: 'number', min, max, step: type === 'integer' ? 1 : 'any', title: name});
      row.slider.addEventListener('input', () => { row.number.value = row.slider.value; });
      for (const input of [row.slider, row.number]) {
        input.addEventListener('change', () => this.set(row, Number(input.value)));
      }
      row.inputs.push(row.slider, row.number);
    }
    row.back = make('button', {textContent: 'Default', title: 'Back to the default'});
    row.back.addEventListener('click', () => this.set(row, row.parameter.default));
    controls.append(...row.inputs, make('span', {textContent: unit}), row.back);
    const range = type === 'boolean' ? '' : `${shown(min)} to ${shown(max)} ${unit}, `;
    box.append(head, controls,
               make('p', {className: 'small', textContent: description}),
               make('p', {className: 'small faint', textContent:
                   `${range}default ${shown(parameter.default)}; effect: ${effect}`}), row.obstacle);
    this.rows.set(name, row);
    this.showValue(row);
    return box;
  }

  showValue(row) {
    const {value} = row.parameter, changed = isChanged(row.parameter);
    if (row.toggle) row.toggle.checked = value;
    else {
      row.slider.value = value;
      row.number.value = shown(value);
    }
    row.box.classList.toggle('changed', changed);
    row.back.hidden = !changed;
  }

  enable() {
    for (const row of this.rows.values()) {
      const obstacle = this.state.obstacle('param.set', row.parameter.name);
      for (const input of [...row.inputs, row.back]) input.disabled = Boolean(obstacle);
      say(row.obstacle, obstacle);
    }
  }

  async set(row, value) {
    const {name} = row.parameter;
    try {
      const {note} = await this.call('param.set', {name, value}) ?? {};
      if (note) tell(`${name}: ${note}`);
    } catch (error) {
      tell(error.message, true);
    }
    await this.read(name);
  }

  // Of one that this page or another client has changed.
  async read(name) {
    const i = this.list.findIndex((one) => one.name === name);
    if (i < 0) return;
    try {
      this.list[i] = {...this.list[i], ...await this.call('param.get', {name})};
    } catch (error) {
      tell(`${name}: ${error.message}`, true);
    }
    const row = this.rows.get(name);
    if (!row) return;
    row.parameter = this.list[i];
    this.showValue(row);
  }
}
