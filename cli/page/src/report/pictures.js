// SPDX-License-Identifier: Apache-2.0
// The plots and the robot as pictures: the page is then nothing but <img id="NAME" src="data:...">,
// which gaitctl takes out of it.
import {listPlots} from '../shared/plots.js';
import {Scene} from '../shared/scene.js';

const kWidth = 1100, kHeight = 540;  // px, of a plot without its title
const kTitle = 34, kLegend = 30;

function canvasOf(width, height) {
  const canvas = Object.assign(document.createElement('canvas'), {width, height});
  const context = canvas.getContext('2d');
  context.fillStyle = '#ffffff';
  context.fillRect(0, 0, width, height);
  context.fillStyle = '#222222';
  return [canvas, context];
}

// A plot under its title, with the names of its lines below.
function framed(title, plot) {
  const {width, height} = plot.ctx.canvas;
  const [canvas, context] = canvasOf(width, kTitle + height + kLegend);
  context.font = 'bold 16px sans-serif';
  context.fillText(title, 12, 23);
  context.drawImage(plot.ctx.canvas, 0, kTitle);
  context.font = '13px sans-serif';
  let x = 60;
  for (const [i, {label, stroke, scale}] of plot.series.entries()) {
    if (i === 0 || scale === 'states') continue;
    context.fillStyle = stroke(plot, i);
    context.fillRect(x, kTitle + height + 6, 12, 12);
    context.fillStyle = '#222222';
    context.fillText(label, x + 17, kTitle + height + 17);
    x += 37 + context.measureText(label).width;
  }
  return canvas;
}

// The robot in the middle of the log.
function replay(log, element) {
  element.style.cssText = `width: ${kWidth}px; height: ${kHeight}px`;
  const scene = new Scene(element, log);
  scene.renderer.setPixelRatio(2);  // smooths the edges
  scene.show(log.time[log.rows >> 1]);
  const [canvas, context] = canvasOf(kWidth, kHeight);
  context.drawImage(scene.renderer.domElement, 0, 0, kWidth, kHeight);
  return canvas;
}

export async function addPictures(log) {
  const place = document.createElement('div');
  document.body.replaceChildren(place);
  const canvases = new Map([['replay', replay(log, place)]]);
  for (const {id, title, make} of listPlots(log)) {
    const plot = make(undefined, place, kWidth, kHeight);
    await Promise.resolve();  // uPlot draws when this task is done
    canvases.set(id, framed(title, plot));
    plot.destroy();
  }
  document.body.replaceChildren(...[...canvases].map(([id, canvas]) =>
      Object.assign(new Image(), {id, src: canvas.toDataURL()})));
}
