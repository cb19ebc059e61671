// SPDX-License-Identifier: Apache-2.0
import {addPlots} from './plots.js';
import {kMarkers, Scene} from './scene.js';

const kControlsPeriod = 100;  // ms between updates of slider and clock while it plays

const $ = (id) => document.getElementById(id);

function row(table, cells, kind = '') {
  const line = $(table).insertRow();
  line.className = kind;
  for (const cell of cells) line.insertCell().textContent = cell;
}

function fillTexts(log) {
  document.title = $('title').textContent = log.title;
  const {verdict} = log;
  if (verdict) {
    $('verdict').textContent = verdict.word;
    $('verdict').className = verdict.good ? 'pass' : 'fail';
    for (const text of log.damage) row('judgements', ['', 'damaged', text], 'fail');
    for (const {name, figure, bound, note, pass} of verdict.expectations) {
      row('judgements', [pass ? 'ok' : 'FAIL', name, figure, bound, note ?? ''], pass ? '' : 'fail');
    }
    for (const [name, value] of Object.entries(verdict.figures)) {
      row('judgements', ['', name, `${value === null ? '-' : Number(value.toPrecision(4))} ${verdict.units[name] ?? ''}`]);
    }
  }
  const fillWhenOpened = (id, rows) => $(id).closest('details').addEventListener(
      'toggle', () => { for (const cells of rows) row(id, cells); }, {once: true});
  fillWhenOpened('events', log.events.map(
      ({time, kind, text}) => [`${time.toFixed(3)} s`, kind, JSON.stringify(text)]));
  fillWhenOpened('configuration', Object.entries(log.metadata));
  $('legend').innerHTML = kMarkers.map(({name, color}) =>
      `<span><i style="background:${color}"></i>${name}</span>`).join('');
}

// The page as one uses it: replay, slider and plots move together. Gives what it is made of.
export function play(log) {
  const [start, end] = [log.time[0], log.time[log.rows - 1]];

  const player = {time: start, playing: false, frames: 0, go};

  function move(time) {
    player.time = Math.min(end, Math.max(start, time));
    player.changed = true;
  }

  function showControls() {
    $('slider').value = player.time;
    $('clock').value = `${player.time.toFixed(2)} s of ${end.toFixed(2)} s`;
  }

  function go(time) {
    move(time);
    showControls();
  }

  fillTexts(log);
  $('slider').min = start;
  $('slider').max = end;
  go(start);
  const scene = new Scene($('scene'), log);
  const plots = addPlots(log, player, $('plots'));

  $('slider').addEventListener('input', () => go(Number($('slider').value)));
  $('play').addEventListener('click', () => {
    player.playing = !player.playing;
    if (player.playing && player.time >= end) go(start);
    $('play').textContent = player.playing ? 'Pause' : 'Play';
    showControls();
  });

  let last = performance.now(), controls = last;
  function frame(now) {
    if (player.playing) {
      move(player.time + (now - last) / 1000 * Number($('speed').value));
      // Not with each frame: where there is no graphics card, painting them costs more than the robot.
      if (now >= controls + kControlsPeriod) {
        controls = now;
        showControls();
      }
      if (player.time >= end) $('play').click();
    }
    if (player.playing) scene.adapt(now - last);
    last = now;
    scene.update(log.row(player.time));
    if (player.changed) {
      player.changed = false;
      for (const {plot} of plots) plot.placeTime?.();
    }
    ++player.frames;
    requestAnimationFrame(frame);
  }
  requestAnimationFrame(frame);
  return {log, player, plots, scene};
}
