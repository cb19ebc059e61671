// SPDX-License-Identifier: Apache-2.0
import {listenToKeys} from './keys.js';
import {addLegend} from '../shared/legend.js';
import {addPlots} from '../shared/plots.js';
import {Scene} from '../shared/scene.js';

const kControlsPeriod = 100;  // ms between updates of slider and clock while it plays

const $ = (id) => document.getElementById(id);

function row(table, cells, kind = '') {
  const line = $(table).insertRow();
  line.className = kind;
  for (const cell of cells) line.insertCell().textContent = cell;
}

function heading(table, text) {
  const cell = document.createElement('th');
  cell.colSpan = 5;
  cell.textContent = text;
  $(table).insertRow().append(cell);
}

function fillVerdict(log) {
  const {verdict} = log;
  if (!verdict) return;
  for (const text of log.damage) row('judgements', ['', 'damaged', text], 'fail');
  for (const {name, figure, bound, note, pass} of verdict.expectations) {
    row('judgements', [pass ? 'ok' : 'FAIL', name, figure, bound, note ?? ''], pass ? '' : 'fail');
  }
  for (const [name, value] of Object.entries(verdict.figures)) {
    row('judgements', ['', name, `${value === null ? '-' : Number(value.toPrecision(4))} ${verdict.units[name] ?? ''}`]);
  }
}

function fillTexts(log) {
  const several = log.all.length > 1;
  const head = (table, one) => several && heading(table, one.name);
  document.title = $('title').textContent = log.all.map((one) => several ? one.name : one.title).join(' and ');
  for (const one of log.all) {
    if (!one.verdict) continue;
    const word = Object.assign(document.createElement('span'), {
        className: one.verdict.good ? 'pass' : 'fail',
        textContent: (several ? `${one.name}: ` : '') + one.verdict.word});
    $('verdict').append(word, ' ');
    head('judgements', one);
    fillVerdict(one);
  }
  const fillWhenOpened = (id, rowsOf) => $(id).closest('details').addEventListener('toggle', () => {
    for (const one of log.all) {
      head(id, one);
      for (const cells of rowsOf(one)) row(id, cells);
    }
  }, {once: true});
  fillWhenOpened('events', (one) => one.events.map(
      ({time, kind, text}) => [`${time.toFixed(3)} s`, kind, JSON.stringify(text)]));
  fillWhenOpened('configuration', (one) => Object.entries(one.metadata));
  addLegend($('legend'), log.all.some((one) => one.pushes.length));
  if (several) $('legend').append(`ghost: ${log.all.slice(1).map(({name}) => name).join(', ')}`);
}

// The page as one uses it: replay, slider and plots move together. Gives what it is made of.
export function play(log) {
  const start = Math.min(...log.all.map((one) => one.start));
  const end = Math.max(...log.all.map((one) => one.end));

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

  const faster = (by) => {
    const speed = $('speed'), most = speed.options.length - 1;
    speed.selectedIndex = Math.min(most, Math.max(0, speed.selectedIndex + by));
  };
  listenToKeys({
    toggle: () => $('play').click(),
    move: (seconds) => go(player.time + seconds),
    rows: (count) => go(log.time[Math.min(log.rows - 1, Math.max(0, log.row(player.time) + count))]),
    start: () => go(start), end: () => go(end),
    faster: () => faster(1), slower: () => faster(-1),
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
    scene.update(player.time);
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
