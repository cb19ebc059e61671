// SPDX-License-Identifier: Apache-2.0
import {$, enable, say} from '../shared/dom.js';
import {tell, told} from './toast.js';

const number = (id) => Number($(id).value);

// Button, method, what it says where it can be used, params.
const kCommands = [
  ['arm', 'arm', 'Enable the drives and take the standing posture'],
  ['disarm', 'disarm', 'Take the joints out of control'],
  ['stand', 'mode', 'End a walk and stand', () => ({mode: 'stand'})],
  ['walk-straight', 'mode', 'Straight knees from the next step on', () => ({mode: 'walk-straight'})],
  ['walk-bent', 'mode', 'Bent knees from the next step on', () => ({mode: 'walk-bent'})],
  ['stop', 'stop', 'Finish the step, close the feet and stand: space'],
  ['reset', 'reset', 'Clear a latched fault'],
  ['sim-reset', 'sim.reset', 'Put the robot back to the start'],
  ['walk', 'walk', 'Footsteps ahead', () => ({steps: number('steps'), length: number('length')})],
];

const kModes = ['stand', 'walk-straight', 'walk-bent'];

// The buttons, and what keys do as they do.
export function addCommands(state, call) {
  for (const [id, method, title, params] of kCommands) {
    const button = $(id);
    button.addEventListener('click', () => told(button.textContent, call(method, params?.())));
    state.addEventListener('change', () => enable(button, state.obstacle(method), title));
  }
  $('pause').addEventListener('click', () => {
    const method = state.status?.paused ? 'resume' : 'pause';
    told(method, call(method));
  });
  state.addEventListener('change', () => {
    enable($('pause'), state.obstacle('pause'), 'Stand after this step and keep the footsteps ahead');
    $('sim-reset').hidden = state.connected && !state.simulation;
  });
  state.addEventListener('status', () => {
    say($('pause'), state.status?.paused ? 'Resume' : 'Pause');
    for (const mode of kModes) $(mode).setAttribute('aria-pressed', state.status?.mode === mode);
  });
  return {stop: () => {
    const obstacle = state.obstacle('stop');
    if (obstacle) tell(`stop: ${obstacle}`, true);
    else $('stop').click();
  }};
}
