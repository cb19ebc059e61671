// SPDX-License-Identifier: Apache-2.0
import {$, isText, make, takesSpaces} from '../shared/dom.js';

const kShown = [
  ['Esc', 'E-STOP, from anywhere on the page'], ['Space', 'stop: finish the step and stand'],
  ['W S', 'forwards, backwards while held'], ['A D', 'turn to the left, to the right'],
  ['Q E', 'to the left, to the right'], ['?', 'show or hide this list'],
];
const kOthers = [
  ['Stick', 'forwards and turn; with Shift sideways. The strip below: sideways'],
  ['Gamepad', 'left stick goes, right stick turns; right button (B) stops, Select is the E-STOP'],
  ['Robot', 'in a simulation: drag a part of it to push it'],
  ['Go to…', 'then click on the ground; drag there to say where to look at the end'],
  ['Scene', 'drag elsewhere to turn, right button to shift, wheel to zoom'],
];

// Not a modal dialog: the E-STOP has to stay within reach.
const toggleList = () => { $('keys').open = !$('keys').open; };

// `actions`: {estop(), stop(), driveDown(code) and isDriving(code), true if it is a key for driving, driveUp(code),
// release(): of all keys for driving}.
export function listenToKeys(actions) {
  for (const [key, meaning] of [...kShown, ...kOthers]) {
    const line = $('keys').querySelector('table').insertRow();
    line.insertCell().append(make('kbd', {textContent: key}));
    line.insertCell().textContent = meaning;
  }
  $('help').addEventListener('click', toggleList);
  $('keys').querySelector('button').addEventListener('click', toggleList);
  // Before any element has it.
  addEventListener('keydown', (event) => {
    const {key, code, target, repeat} = event;
    // Of keys that are let go while it is held macOS tells nothing.
    if (key === 'Meta') actions.release();
    if (key === 'Escape') {
      event.preventDefault();
      if (!repeat) actions.estop();
      return;
    }
    if (event.ctrlKey || event.altKey || event.metaKey || takesSpaces(target)) return;
    if (key === ' ') {
      // Also on a button that has the focus: who has just clicked Walk wants to stop, not to walk again. And in
      // the number beside it.
      event.preventDefault();
      if (!repeat) (target.id === 'estop' ? actions.estop : actions.stop)();
    } else if (isText(target)) {
      return;
    } else if (key === '?') {
      toggleList();
    } else if (repeat ? actions.isDriving(code) : actions.driveDown(code)) {
      event.preventDefault();
    }
  }, {capture: true});
  addEventListener('keyup', (event) => {
    actions.driveUp(event.code);
    if (event.key === 'Meta') actions.release();
    if (event.key === ' ' && !takesSpaces(event.target)) event.preventDefault();
  }, {capture: true});
  addEventListener('contextmenu', () => actions.release());
}
