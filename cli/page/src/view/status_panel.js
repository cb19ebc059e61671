// SPDX-License-Identifier: Apache-2.0
import {$, make, say} from '../shared/dom.js';

const number = (value, digits) => typeof value === 'number' ? value.toFixed(digits) : '–';
const kMega = 1e6;
const kOld = 0.5;  // s
const kForget = 5000, kManyLost = 100;  // ms, frames in that time: a few are no reason for words

// Label and text of each line; '' is left blank.
const kLines = [
  ['state', (s) => s.state],
  ['mode', (s) => s.mode],
  ['phase', (s) => `${s.phase ?? '–'}, ${s.support ?? '–'}`],
  ['step', (s) => `${s.step_index ?? '–'}, ${s.footsteps_ahead ?? 0} ahead${s.paused ? ', PAUSED' : ''}`],
  ['ICP margin', (s) => typeof s.icp_margin === 'number' ? `${number(1000 * s.icp_margin, 0)} mm` : '–'],
  ['ICP error', (s) => typeof s.icp_error === 'number' ? `${number(1000 * s.icp_error, 1)} mm` : '–'],
  ['pull', (s) => !s.external ? 'unknown: no tare yet, or feet without force sensors' :
      `${s.external.force.map((f) => number(f, 0)).join(', ')} N${s.external.pulled ? ', counted on' : ''}`],
  ['carries', (s) => !s.payload?.loads?.length ? 'nothing' :
      s.payload.loads.map((l) => `${number(l.mass, 1)} kg on ${l.link}`).join(', ')],
  ['holds on', (s) => Object.entries(s.handholds ?? {}).filter(([, h]) => h.state !== 'none')
      .map(([hand, h]) => `${hand} hand, ${h.state}, up to ${number(h.force_max, 0)} N`).join('; ') || 'nothing'],
  ['tick', (s) => `${number(s.tick_us, 0)} µs, longest ${number(s.tick_longest_us, 0)} µs`],
  ['overruns', (s) => `${s.overruns ?? '–'}${s.late ? `, last: ${s.late.what}, ${number(s.late.time_us, 0)} µs` : ''}`],
  ['clock', (s) => `${s.clock ?? '–'}, ${number(s.time, 1)} s`],
  ['real time', (s) => s.realtime?.degraded?.join('; ') || 'as it should be'],
  ['log', (s) => !s.log ? '–' : s.log.open ?
      `${s.log.file.split('/').at(-1)}, ${number(s.log.bytes / kMega, 1)} MB` : 'not open'],
  ['health', (s) => s.health ? (s.health.healthy ? 'good' : s.health.text) : 'simulation'],
  ['robot', (s) => `${s.robot ?? '–'}, ${s.backend ?? '–'}${s.scenario ? `, plays ${s.scenario}` : ''}`],
];

// What has to be seen at once: [text, kind] each.
function alerts(state, connection, view) {
  if (!state.online) return [[connection.state.text, 'bad']];
  const found = [];
  const {status} = state;
  if (!state.connected) {
    found.push([`gaitd is away${state.reason ? `: ${state.reason}` : ''}; trying again`, 'bad']);
  } else if (state.silent > 1) {
    found.push([`gaitd has not answered for ${number(state.silent, 0)} s: all that is shown is old`, 'bad']);
  } else if (status) {
    if (status.faults?.length) found.push([`FAULT: ${status.faults.join(', ')} – reset, then arm`, 'bad']);
    if (status.stale) {
      const where = status.hangs_in ? ` in ${status.hangs_in}` : '';
      found.push([`The control loop hangs${where}: its last round was ${number(status.age, 1)} s ago`, 'bad']);
    }
    if (status.health && !status.health.healthy) found.push([`Not healthy: ${status.health.text}`, 'bad']);
    if (status.joints_dropped) found.push([`${status.joints_dropped} joints have failed and are damped`, 'bad']);
    if (status.log?.error) found.push([`Log: ${status.log.error}`, 'bad']);
    if (status.log?.dropouts) found.push([`The log lacks ${status.log.dropouts} ticks`, 'bad']);
  }
  if (connection.lag > kOld) {
    found.push([`A slow connection: all that is shown may be ${number(connection.lag, 1)} s old`, 'bad']);
  }
  if (state.role === 'observe') {
    found.push(['Watching only: this address may stop the robot, nothing else', 'note']);
  }
  if (view.lost > kManyLost) found.push([`This connection was too slow for ${view.lost} frames`, 'note']);
  return found;
}

function fillAlerts(list) {
  const element = $('alerts'), key = JSON.stringify(list);
  if (element.dataset.key === key) return;
  element.dataset.key = key;
  element.replaceChildren(...list.map(([text, kind]) => make('div', {className: kind, textContent: text})));
}

export function addStatus(state, connection) {
  const cells = kLines.map(([label]) => {
    const cell = make('dd');
    $('status').append(make('dt', {textContent: label}), cell);
    return cell;
  });
  const view = {lost: 0};
  let forget;
  const change = () => {
    fillAlerts(alerts(state, connection, view));
    const old = state.silent > 1 || connection.lag > kOld;
    document.body.classList.toggle('away', !state.online || !state.connected || old);
    const name = state.connected ? state.name : '';
    say($('title'), name || 'gaitd');
    document.title = name ? `${name} – gaitd` : 'gaitd';
    say($('role'), !state.online ? 'offline' : state.role === 'observe' ? 'watching only' : state.role);
    say($('viewers'), state.online && state.viewers > 1 ? `${state.viewers} watch` : '');
    say($('state'), state.connected && state.status?.state ? state.status.state : '–');
    $('state').className = state.connected ? `is-${state.status?.state}` : '';
  };
  state.addEventListener('change', change);
  connection.addEventListener('lag', change);
  state.addEventListener('status', () => {
    const status = state.status ?? {};
    kLines.forEach(([, text], i) => say(cells[i], String(text(status) ?? '–')));
    change();
  });
  connection.addEventListener('lost', ({detail}) => {
    view.lost += detail.frames;
    forget ??= setTimeout(() => {
      view.lost = 0;
      forget = undefined;
    }, kForget);
  });
  change();
}
