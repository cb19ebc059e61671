// SPDX-License-Identifier: Apache-2.0
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';

const kColors = ['#1f77b4', '#d62728', '#2ca02c', '#ff7f0e', '#9467bd', '#8c564b', '#e377c2', '#17becf'];
const kHeight = 190;

// What is plotted over time: a title, a unit, and signals with their labels.
function panels(log) {
  const legs = JSON.parse(log.metadata.legs ?? '{}');
  const limits = Object.fromEntries(
      JSON.parse(log.metadata.joints ?? '[]').map((joint) => [joint.name, joint.effort_limit]));
  const sides = ['left', 'right'];
  const knees = sides.map((side) => [side, legs[side]?.knee]).filter(([, knee]) => knee);
  const lines = (...list) => list.filter(([name]) => log.has(name))
      .map(([name, label, scale = 1]) => ({name, label, scale}));
  const torques = sides.flatMap((side) => (legs[side]?.joints ?? [])
      .map((joint) => [`joint/${joint}/torque_desired`, joint, 1 / (limits[joint] || NaN)]));
  return [
    {id: 'icp-x', title: 'Capture point, x', unit: 'm', lines: lines(
        ['icp/x', 'measured'], ['icp/desired/x', 'planned'], ['cop/x', 'CoP'], ['cmp/desired/x', 'CMP'])},
    {id: 'icp-y', title: 'Capture point, y', unit: 'm', lines: lines(
        ['icp/y', 'measured'], ['icp/desired/y', 'planned'], ['cop/y', 'CoP'], ['cmp/desired/y', 'CMP'])},
    {id: 'com-height', title: 'Height of the centre of mass', unit: 'm', lines: lines(
        ['com/z', 'estimated'], ['truth/com/z', 'true'], ['com/height_target', 'target'])},
    {id: 'knees', title: 'Knee angles and states of the legs', unit: 'rad', lines: lines(
        ...knees.flatMap(([side, knee]) => [[`joint/${knee}/position`, side],
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

// Transfer phases shaded, toe-off marked above.
function shades(log) {
  const transfers = log.spans('gait/phase', 'transfer'), toeOffs = log.spans('toe_off/active');
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
    fill(transfers, '#0000000f', 0, bbox.height);
    fill(toeOffs, '#ff7f0e', 0, 4 * devicePixelRatio);
    ctx.restore();
  }]}};
}

// The time of the replay as a line of its own above the plot, which is not drawn again for it; a click
// goes there.
function cursor(player) {
  const place = (plot) => plot.placeTime?.();
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

function timePlot(log, panel, player, element, width, height) {
  const states = panel.states ? {label: 'states', value: (_, __, ___, row) => row === null ? '' :
      ['left', 'right'].map((side) => log.word(`leg/${side}/state`, row)).join(', '),
      show: true, points: {show: false}} : undefined;
  const data = [log.time, ...panel.lines.map(({name, scale}) =>
      scale === 1 ? log.column(name) : log.column(name).map((value) => value * scale))];
  if (states) data.push(new Float32Array(log.rows).fill(NaN));
  return new uPlot({
    width, height, cursor: {sync: {key: 'time'}},
    scales: {x: {time: false}},
    axes: [{label: 's', labelSize: 16, size: 32}, {label: panel.unit, size: 56}],
    series: [{label: 't'}, ...panel.lines.map(({label}, i) => (
        {label, stroke: kColors[i % kColors.length], width: 1})), ...(states ? [states] : [])],
    plugins: [shades(log), cursor(player)],
  }, data, element);
}

function pathPlot(log, element, width, height) {
  const path = (name) => [log.column(`${name}/x`), log.column(`${name}/y`)];
  const names = ['icp', 'icp/desired', 'com'].filter((name) => log.has(`${name}/x`));
  const draw = (plot, series) => {
    const [xs, ys] = plot.data[series];
    plot.ctx.save();
    plot.ctx.strokeStyle = kColors[series - 1];
    plot.ctx.lineWidth = devicePixelRatio;
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
    for (const name of names) {
      for (const v of log.column(`${name}/${axis}`)) {
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
    axes: [{label: 'x, m', labelSize: 16, size: 32}, {label: 'y, m', size: 56}],
    series: [{}, ...names.map((label, i) => ({label: {icp: 'capture point', 'icp/desired': 'planned',
        com: 'centre of mass'}[label], stroke: kColors[i], paths: draw}))],
  }, [null, ...names.map(path)], element);
}

// All plots below `element`, or only the one with the id `only`. A plot is made when it comes into
// view: the list grows as they are.
export function addPlots(log, player, element, only) {
  const width = Math.max(400, element.clientWidth - 30);
  const height = only ? 480 : kHeight;
  const plots = [], makers = new Map();
  const watcher = new IntersectionObserver((entries) => {
    for (const {target, isIntersecting} of entries) {
      if (!isIntersecting) continue;
      watcher.unobserve(target);
      makers.get(target)();
    }
  });
  const add = (id, title, make) => {
    if (only && only !== id) return;
    const box = document.createElement('div');
    box.id = `plot-${id}`;
    box.innerHTML = `<h2>${title}</h2>`;
    element.append(box);
    box.style.minHeight = `${height}px`;
    watcher.observe(box);
    makers.set(box, () => plots.push({id, plot: make(box)}));
  };
  add('icp-path', 'Capture point from above', (box) => pathPlot(log, box, width, height));
  for (const panel of panels(log)) {
    add(panel.id, panel.title, (box) => timePlot(log, panel, player, box, width, height));
  }
  return plots;
}
