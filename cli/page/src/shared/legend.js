// SPDX-License-Identifier: Apache-2.0
import {kMarkers} from './scene.js';
import {kPushColor} from './theme.js';

// What the colours on the ground mean; `pushes`: whether there are any.
export function addLegend(element, pushes) {
  for (const {name, color} of [...kMarkers, ...(pushes ? [{name: 'push', color: kPushColor}] : [])]) {
    const mark = document.createElement('i');
    mark.style.background = color;
    const entry = document.createElement('span');
    entry.append(mark, name);
    element.append(entry);
  }
}
