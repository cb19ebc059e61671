// SPDX-License-Identifier: Apache-2.0
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import {kPushColor, lineColor, theme} from './theme.js';

const kHeight = 190;

// What is plotted over time: a title, a unit, and signals with their labels.
export function panels(log) {
  const {legs, efforts} = log;
  const sides = ['left', 'right'];
  const knees = sides.map((side) => [side, legs[side]?.knee]).filter(([, knee]) => knee);
  const lines = (...list) => list.filter(([name]) => log.has(name))
      .map(([name, label, scale = 1, zero = 0]) => ({name, label, scale, zero}));
  // Its bend, as that which is wanted: from where the leg is straight.
  const kneeBend = (side, knee) => [`joint/${knee}/position`, side, legs[side].knee_bend_sign ?? 1,
                                    legs[side].knee_straight ?? 0];
  const torques = sides.flatMap((side) => (legs[side]?.joints ?? [])
      .map((joint) => [`joint/${joint}/torque_desired`, joint, 1 / (efforts[joint] || NaN)]));
  return [
    {id: 'icp-x', title: 'Capture point, x', unit: 'm', lines: lines(
        ['icp/x', 'measured'], ['icp/desired/x', 'planned'], ['cop/x', 'CoP'], ['cmp/desired/x', 'CMP'])},
    {id: 'icp-y', title: 'Capture point, y', unit: 'm', lines: lines(
        ['icp/y', 'measured'], ['icp/desired/y', 'planned'], ['cop/y', 'CoP'], ['cmp/desired/y', 'CMP'])},
    {id: 'com-height', title: 'Height of the centre of mass', unit: 'm', lines: lines(
        ['com/z', 'estimated'], ['truth/com/z', 'true'], ['com/height_target', 'target'])},
    {id: 'knees', title: 'Knee angles and states of the legs', unit: 'rad', lines: lines(
        ...knees.flatMap(([side, knee]) => [kneeBend(side, knee),
                                            [`leg/${side}/knee_privileged`, `${side}, wanted`]])),
     states: 'leg'},
    {id: 'torques', title: 'Torques of the legs over their limits', unit: '1', lines: lines(...torques)},
    {id: 'forces', title: 'Vertical contact forces', unit: 'N', lines: lines(
        ...sides.flatMap((side) => [[`foot/${side}/force/z`, side],
                                    [`foot/${side}/force_desired/z`, `${side}, wanted`]]))},
    {id: 'step-adjustment', title: 'Step adjustment', unit: 'm, s', lines: lines(
        ['step_adjust/dx', 'dx'], ['step_adjust/dy', 'dy'], ['step_adjust/time_shift', 'time'])},
    {id: 'tick-times', title: 'Longest times of a tick', unit: 'µs', lines: lines(
        ['tick/total_us', 'total'], ['tick/wbc_us', 'whole body'], ['tick/estimator_us', 'estimator'])},
  ].filter((panel) => panel.lines.length);
}

// What `make` gives of a log, made again only if that has grown.
function upToDate(log, make) {
  let made, version;
  return () => {
    if (made === undefined || version !== log.version) [made, version] = [make(), log.version];
    return made;
  };
}

// Transfer phases shaded, toe-off marked above.
function shades(log) {
  const transfers = upToDate(log, () => log.spans('gait/phase', 'transfer'));
  const toeOffs = upToDate(log, () => log.spans('toe_off/active'));
  return {hooks: {drawClear: [(plot) => {
    const {ctx, bbox} = plot;
    ctx.save();
    const fill = (spans, color, top, height) => {
      ctx.fillStyle = color;
      for (const [from, to] of spans) {
        const left = Math.max(bbox.left, plot.valToPos(from, 'x', true));
        const right = Math.min(bbox.left + bbox.width, plot.valToPos(to, 'x', true));
        if (right > left) ctx.fillRect(left, bbox.top + top, right - left, height);
      }
    };
    fill(transfers(), theme.phase, 0, bbox.height);
    fill(toeOffs(), '#ff7f0e', 0, 4 * devicePixelRatio);
    ctx.restore();
  }]}};
}

// A band for the time of each push, its force above.
function pushMarks(log) {
  return {hooks: {draw: [(plot) => {
    const {ctx, bbox} = plot;
    ctx.save();
    ctx.font = `${10 * devicePixelRatio}px sans-serif`;
    ctx.textBaseline = 'top';
    for (const {time, duration, force} of log.all.flatMap((one) => one.pushes)) {
      const left = plot.valToPos(time, 'x', true), right = plot.valToPos(time + duration, 'x', true);
      if (right < bbox.left || left > bbox.left + bbox.width) continue;
      ctx.fillStyle = `${kPushColor}40`;
      ctx.fillRect(left, bbox.top, Math.max(devicePixelRatio, right - left), bbox.height);
      ctx.fillStyle = kPushColor;
      const text = `push, ${Math.hypot(...force).toFixed(0)} N`, top = bbox.top + 5 * devicePixelRatio;
      const fits = right + 3 + ctx.measureText(text).width < bbox.left + bbox.width;
      ctx.textAlign = fits ? 'left' : 'right';
      ctx.fillText(text, fits ? right + 3 : left - 3, top);
    }
    ctx.restore();
  }]}};
}

// Below, a band for each leg (left above right) in a colour for each of its states, with their words
// where there is room.
function stateBands(log) {
  const kBand = 11, kWordColor = '#ffffff';
  const bandsOf = upToDate(log, () => ['left', 'right'].map((side) => log.words(`leg/${side}/state`)
      .flatMap((word, i) => log.spans(`leg/${side}/state`, word)
          .map(([from, to]) => ({word, color: lineColor(i), from, to})))));
  return {hooks: {draw: [(plot) => {
    const {ctx, bbox} = plot, height = kBand * devicePixelRatio, bands = bandsOf();
    ctx.save();
    ctx.font = `${9 * devicePixelRatio}px sans-serif`;
    ctx.textAlign = 'left';
    ctx.textBaseline = 'middle';
    bands.forEach((band, i) => {
      const top = bbox.top + bbox.height - (bands.length - i) * height;
      for (const {word, color, from, to} of band) {
        const left = Math.max(bbox.left, plot.valToPos(from, 'x', true));
        const right = Math.min(bbox.left + bbox.width, plot.valToPos(to, 'x', true));
        if (right <= left) continue;
        ctx.fillStyle = color;
        ctx.fillRect(left, top, right - left, height - 1);
        if (ctx.measureText(word).width + 4 > right - left) continue;
        ctx.fillStyle = kWordColor;
        ctx.fillText(word, left + 2, top + height / 2);
      }
    });
    ctx.restore();
  }]}};
}

// The time of the replay as a line of its own above the plot, which is not drawn again for it; a click
// goes there.
function cursor(player) {
  const place = (plot) => plot.placeTime?.();
  if (!player) return {hooks: {}};
  return {hooks: {
    ready: [(plot) => {
      const line = document.createElement('div');
      line.className = 'now';
      plot.over.append(line);
      let shown;
      plot.placeTime = () => {
        const x = Math.round(plot.valToPos(player.time, 'x'));
        if (x === shown) return;
        shown = x;
        line.hidden = !(x >= 0 && x <= plot.bbox.width / devicePixelRatio);
        line.style.transform = `translateX(${x}px)`;
      };
      plot.placeTime();
      plot.over.addEventListener('click', (event) => player.go(plot.posToVal(event.offsetX, 'x')));
    }],
    setScale: [place],
    setSize: [place],
  }};
}

const axis = (label, size) => ({label, ...size, stroke: theme.ink, grid: {stroke: theme.grid},
                                ticks: {stroke: theme.grid}});

// Of several logs each line says whose it is.
const named = (log, one, label) => log.all.length > 1 ? `${label}, ${one.name}` : label;

// `options`: of uPlot, in place of those here. `refresh` of what it gives draws what has come to the log.
export function timePlot(log, panel, player, element, width, height, options = {}) {
  // Over the times of the longest.
  const longest = () => log.all.reduce((longest, one) => one.end > longest.end ? one : longest);
  // Without values of its own: the words under the mouse, on a scale that is not the one of the lines.
  const states = panel.states ? {label: 'states', scale: 'states', points: {show: false},
      value: (_, __, ___, row) => row === null ? '' : ['left', 'right'].map(
          (side) => log.word(`leg/${side}/state`, log.row(longest().time[row]))).join(', ')} : undefined;
  const lines = log.all.flatMap((one, k) => panel.lines.map((line, i) => ({...line, one, k, i}))
      .filter(({name}) => one.has(name)));
  const data = () => {
    const {time} = longest();
    const columns = lines.map(({one, name, scale, zero}) => {
      const column = one.columnAt(name, time);
      return scale === 1 && !zero ? column : column.map((value) => (value - zero) * scale);
    });
    return [time, ...columns, ...(states ? [new Float32Array(time.length).fill(NaN)] : [])];
  };
  const plot = new uPlot({
    width, height, cursor: {sync: {key: 'time'}, ...options.cursor},
    scales: {x: {time: false, ...options.x}, states: {range: [0, 1]}, ...(options.y && {y: options.y})},
    axes: [{...axis('s', {labelSize: 16, size: 32}), ...options.axis}, axis(panel.unit, {size: 56})],
    series: [{label: 't'}, ...lines.map(({label, one, k, i}) => ({
        label: named(log, one, label), stroke: lineColor(i, k), width: 1, dash: k ? [6, 4] : undefined})),
             ...(states ? [states] : [])],
    plugins: [shades(log), cursor(player), ...(states ? [stateBands(log)] : []), pushMarks(log)],
  }, data(), element);
  plot.refresh = () => plot.setData(data());
  return plot;
}

const kPaths = {icp: 'capture point', 'icp/desired': 'planned', com: 'centre of mass'};

function pathPlot(log, element, width, height) {
  const paths = log.all.flatMap((one, k) => Object.keys(kPaths).map((name, i) => ({one, k, i, name}))
      .filter(({name}) => one.has(`${name}/x`)));
  const draw = (plot, series) => {
    const [xs, ys] = plot.data[series], {i, k} = paths[series - 1];
    plot.ctx.save();
    plot.ctx.strokeStyle = lineColor(i, k);
    plot.ctx.lineWidth = devicePixelRatio;
    if (k) plot.ctx.setLineDash([6, 4]);
    plot.ctx.beginPath();
    for (let i = 0; i < xs.length; ++i) {
      plot.ctx.lineTo(plot.valToPos(xs[i], 'x', true), plot.valToPos(ys[i], 'y', true));
    }
    plot.ctx.stroke();
    plot.ctx.restore();
    return null;
  };
  const range = (axis) => () => {
    let low = Infinity, high = -Infinity;
    for (const {one, name} of paths) {
      for (const v of one.column(`${name}/${axis}`)) {
        low = Math.min(low, v);
        high = Math.max(high, v);
      }
    }
    const margin = 0.05 * (high - low) + 0.02;
    return [low - margin, high + margin];
  };
  return new uPlot({
    width, height, mode: 2, cursor: {show: false},
    scales: {x: {time: false, range: range('x')}, y: {range: range('y')}},
    axes: [axis('x, m', {labelSize: 16, size: 32}), axis('y, m', {size: 56})],
    series: [{}, ...paths.map(({one, k, i, name}) => (
        {label: named(log, one, kPaths[name]), stroke: lineColor(i, k), paths: draw}))],
  }, [null, ...paths.map(({one, name}) => [one.column(`${name}/x`), one.column(`${name}/y`)])], element);
}

// All plots: {id, title, make(player, element, width, height)}; `make` gives the uPlot.
export function listPlots(log) {
  return [
    {id: 'icp-path', title: 'Capture point from above',
     make: (_, ...place) => pathPlot(log, ...place)},
    ...panels(log).map((panel) => ({id: panel.id, title: panel.title,
        make: (player, ...place) => timePlot(log, panel, player, ...place)})),
  ];
}

// All plots below `element`. A plot is made when it comes into view: the list grows as they are.
export function addPlots(log, player, element) {
  const width = Math.max(400, element.clientWidth - 30);
  const plots = [], makers = new Map();
  const watcher = new IntersectionObserver((entries) => {
    for (const {target, isIntersecting} of entries) {
      if (!isIntersecting) continue;
      watcher.unobserve(target);
      makers.get(target)();
    }
  });
  for (const {id, title, make} of listPlots(log)) {
    const box = document.createElement('div');
    box.id = `plot-${id}`;
    box.append(Object.assign(document.createElement('h2'), {textContent: title}));
    element.append(box);
    box.style.minHeight = `${kHeight}px`;
    watcher.observe(box);
    makers.set(box, () => plots.push({id, plot: make(player, box, width, kHeight)}));
  }
  return plots;
}
