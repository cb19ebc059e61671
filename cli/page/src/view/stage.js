// SPDX-License-Identifier: Apache-2.0
import {Scene} from '../shared/scene.js';
import {$} from '../shared/dom.js';
import {Live} from './live.js';
import {LivePlots} from './live_plots.js';
import {Push} from './push.js';

const kMean = 0.05;  // share of the newest in the mean latency

// Everything that shows the signals of one robot. Another robot, or the same after a restart of gaitd,
// gets a stage of its own.
export class Stage {
  constructor(robot, push, frames) {
    this.live = new Live(robot);
    this.live.efforts = efforts(robot.urdf);
    this.scene = new Scene($('scene'), this.live);
    this.push = new Push(this.scene, push);
    this.scene.beforeDraw = () => this.push.show();
    this.plots = new LivePlots(this.live, $('plots'), () => Number($('seconds').value));
    this.frames = frames;
    this.drawn = undefined;
    this.latency = {last: NaN, mean: NaN, longest: 0};  // ms from the arrival of a frame to its drawing
  }

  append(buffer) {
    if (this.live.append(buffer)) this.arrived = performance.now();
  }

  // Whoever lies on the ground is nowhere by the estimate: that knows of no contacts but those of feet. Of
  // a simulation that has fallen, the truth is drawn.
  set fallen(fallen) {
    this.live.drawnBy = fallen && this.live.index.has('truth/pelvis/x') ? 'truth/pelvis' : 'pelvis';
  }

  // The newest, once per frame of the screen.
  draw(now, passed) {
    const {live, scene} = this;
    if (!live.rows) return;
    scene.adapt(passed);
    const fresh = this.version !== live.version;
    this.version = live.version;
    scene.update(live.end);
    if (fresh) this.count();
    if (!$('panel-plots').hidden) this.plots.draw(now);
  }

  count() {
    const {latency, live} = this, last = performance.now() - this.arrived;
    latency.last = last;
    latency.mean = latency.mean >= 0 ? latency.mean + kMean * (last - latency.mean) : last;
    latency.longest = Math.max(latency.longest, last);
    this.drawn = {time: live.end, tick: live.tick, pelvis: this.scene.pelvis.position.toArray()};
    ++this.frames;
  }

  // Where the camera was, for the next stage.
  get view() { return this.scene.camera.position.clone().sub(this.scene.controls.target); }
  set view(offset) { this.scene.camera.position.copy(this.scene.controls.target).add(offset); }

  remove() {
    this.push.remove();
    this.plots.remove();
    this.scene.remove();
  }
}

// Of the joints by their names, N m.
function efforts(urdf) {
  const joints = new DOMParser().parseFromString(urdf ?? '', 'application/xml').querySelectorAll('robot > joint');
  return Object.fromEntries([...joints].map((joint) =>
      [joint.getAttribute('name'), Number(joint.querySelector('limit')?.getAttribute('effort'))]));
}
