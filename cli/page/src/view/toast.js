// SPDX-License-Identifier: Apache-2.0
import {$, make} from '../shared/dom.js';
import {refused} from './refused.js';

const kMost = 4, kGood = 4000, kBad = 12000;  // ms that they stay
const shown = new Map();  // by their text

// Says `text` at the top of the page for a while; `bad`: a refusal or an error. A click takes it away.
export function tell(text, bad = false) {
  let toast = shown.get(text);
  if (toast) {
    toast.times.textContent = ` ×${++toast.count}`;
    clearTimeout(toast.timer);
  } else {
    const times = make('b');
    toast = {count: 1, times, box: make('div', {className: bad ? 'bad' : '', textContent: text})};
    toast.box.append(times);
    toast.remove = () => {
      toast.box.remove();
      shown.delete(text);
    };
    toast.box.addEventListener('click', toast.remove);
    $('toasts').append(toast.box);
    shown.set(text, toast);
    if (shown.size > kMost) shown.values().next().value.remove();
  }
  toast.timer = setTimeout(toast.remove, bad ? kBad : kGood);
}

// What gaitd answers to `what`, as text: refusals are never silent. Gives the result or undefined.
export async function told(what, answer) {
  try {
    const result = await answer;
    if (result?.note) tell(`${what}: ${result.note}`);
    return result;
  } catch (error) {
    tell(refused(what, error), true);
    return undefined;
  }
}
