// SPDX-License-Identifier: Apache-2.0
import {$} from '../shared/dom.js';

// One of the panels at a time. `opened(name)`: of the panel that is seen now.
export function addTabs(opened) {
  const buttons = [...$('tabs').querySelectorAll('button')];
  const open = (name) => {
    for (const button of buttons) {
      const is = button.dataset.panel === name;
      button.setAttribute('aria-selected', is);
      $(`panel-${button.dataset.panel}`).hidden = !is;
    }
    opened(name);
  };
  for (const button of buttons) button.addEventListener('click', () => open(button.dataset.panel));
  open(buttons[0].dataset.panel);
}
