// SPDX-License-Identifier: Apache-2.0
// What the keyboard does.

// `actions`: {toggle(), move(seconds), rows(count), start(), end(), faster(), slower()}.
const kKeys = [
  [' ', 'Space', 'play or pause', (actions) => actions.toggle()],
  ['ArrowLeft', '←', 'back by 0.1 s, with Shift by 1 s', (actions, shift) => actions.move(shift ? -1 : -0.1)],
  ['ArrowRight', '→', 'forward likewise', (actions, shift) => actions.move(shift ? 1 : 0.1)],
  [',', ',', 'back by one row of the log', (actions) => actions.rows(-1)],
  ['.', '.', 'forward by one row', (actions) => actions.rows(1)],
  ['Home', 'Home', 'to the beginning', (actions) => actions.start()],
  ['End', 'End', 'to the end', (actions) => actions.end()],
  ['-', '−', 'slower', (actions) => actions.slower()],
  ['+', '+', 'faster', (actions) => actions.faster()],
  ['?', '?', 'show or hide these keys', () => toggleList()],
];

function toggleList() {
  const list = document.getElementById('keys');
  if (list.open) list.close();
  else list.showModal();
}

// A button that has the focus is what Space presses; a list and a fold have keys of their own.
const takesKey = (element, key) => element.matches('select, summary') || (key === ' ' && element.matches('button'));

export function listenToKeys(actions) {
  const table = document.querySelector('#keys table');
  for (const [, shown, meaning] of kKeys) {
    const line = table.insertRow();
    line.insertCell().append(Object.assign(document.createElement('kbd'), {textContent: shown}));
    line.insertCell().textContent = meaning;
  }
  document.getElementById('help').addEventListener('click', toggleList);
  addEventListener('keydown', (event) => {
    const {key, target} = event;
    if (event.ctrlKey || event.altKey || event.metaKey || takesKey(target, key)) return;
    const found = kKeys.find(([name]) => name === key);
    if (!found || (document.getElementById('keys').open && key !== '?')) return;
    event.preventDefault();
    found[3](actions, event.shiftKey);
  });
}
