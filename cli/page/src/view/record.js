// SPDX-License-Identifier: Apache-2.0
import {$, enable, say} from '../shared/dom.js';
import {tell} from './toast.js';

// A recording that the server makes of what gaitd tells, and the report of it.
export function addRecord(state, connection, newest) {
  let now = {on: false};
  const show = () => {
    enable($('record'), state.obstacle('record'), now.on ? 'End the recording' : 'Record from now on');
    $('record').setAttribute('aria-pressed', now.on);
    const seconds = now.on ? newest() - now.since : NaN;
    say($('record'), now.on ? `Stop recording${seconds >= 0 ? ` (${seconds.toFixed(0)} s)` : ''}` : 'Record');
    $('report').hidden = !now.report;
  };
  connection.addEventListener('record', ({detail}) => {
    now = detail;
    const lost = detail.lost ? ` without ${detail.lost} frames that the disk was too slow for` : '';
    if (detail.log && !detail.error) tell(`Recorded: ${detail.log}${lost}`, detail.lost > 0);
    if (detail.error) tell(`Recording: ${detail.error}`, true);
    show();
  });
  $('record').addEventListener('click', () => {
    if (!connection.send({type: 'record', on: !now.on})) tell('Recording: there is no connection', true);
  });
  $('report').addEventListener('click', () => openReport(now.report, connection.token));
  state.addEventListener('change', show);
  state.addEventListener('status', show);
}

// It is asked for with the token, which no address may hold; so the tab gets what has been fetched.
async function openReport(path, token) {
  if (!path?.startsWith('/report/')) return;
  // Before anything is waited for, or the browser takes it for one that nobody asked for.
  const tab = window.open('', '_blank');
  try {
    const answer = await fetch(path, {headers: {Authorization: `Bearer ${token}`}});
    if (!answer.ok) throw new Error(`the server answers ${answer.status}`);
    const address = URL.createObjectURL(new Blob([await answer.text()], {type: 'text/html'}));
    if (tab) tab.location = address;
    else location.assign(address);
    setTimeout(() => URL.revokeObjectURL(address), 60e3);
  } catch (error) {
    tab?.close();
    tell(`Report: ${error.message}`, true);
  }
}
