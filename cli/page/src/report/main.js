// SPDX-License-Identifier: Apache-2.0
import '../shared/base.css';
import './report.css';
import {addFilm} from './film.js';
import {Log} from './log.js';
import {addPictures} from './pictures.js';
import {play} from './player.js';

const began = performance.now();
const log = new Log(JSON.parse(document.getElementById('gaitd-data').textContent));
if (location.hash === '#pictures') {
  addPictures(log);  // for gaitctl report --png
} else if (location.hash.startsWith('#film=')) {
  addFilm(log, location.hash.slice(6));  // for gaitctl report --film
} else {
  // For the console of the browser.
  window.gaitd = Object.assign(play(log), {built: performance.now() - began});
}
