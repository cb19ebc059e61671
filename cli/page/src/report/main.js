// SPDX-License-Identifier: Apache-2.0
import '../shared/base.css';
import './report.css';
import {Log} from './log.js';
import {addPictures} from './pictures.js';
import {play} from './player.js';

const began = performance.now();
const log = new Log(JSON.parse(document.getElementById('gaitd-data').textContent));
if (location.hash === '#pictures') {
  addPictures(log);  // for gaitctl report --png
} else {
  // For the console of the browser.
  window.gaitd = Object.assign(play(log), {built: performance.now() - began});
}
