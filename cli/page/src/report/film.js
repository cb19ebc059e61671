// SPDX-License-Identifier: Apache-2.0
// The robot as it moves, frame by frame: the page is then nothing but <img id="NAME" src="data:...">,
// which gaitctl takes out of it and makes a film of.
import {Scene} from '../shared/scene.js';

const kWidth = 480, kHeight = 300;  // px
const kRate = 10;                   // frames per second; cli/report/pictures.cc shows as many
const kMost = 600;                  // frames

// Fewer shades make the file half as large, and look the same.
function coarsen(context) {
  const image = context.getImageData(0, 0, kWidth, kHeight);
  for (let i = 0; i < image.data.length; ++i) {
    if (i % 4 !== 3) image.data[i] = Math.min(255, image.data[i] + 4) & 0xf8;
  }
  context.putImageData(image, 0, 0);
}

export function addFilm(log, span) {
  const place = document.createElement('div');
  place.style.cssText = `width: ${kWidth}px; height: ${kHeight}px`;
  document.body.replaceChildren(place);
  const scene = new Scene(place, log);
  scene.renderer.setPixelRatio(2);  // smooths the edges
  const [from, to] = span.split(',').map(Number);
  const canvas = Object.assign(document.createElement('canvas'), {width: kWidth, height: kHeight});
  const context = canvas.getContext('2d');
  const frames = [];
  for (let i = 0; i < kMost && from + i / kRate <= to; ++i) {
    scene.show(from + i / kRate);
    context.drawImage(scene.renderer.domElement, 0, 0, kWidth, kHeight);
    coarsen(context);
    frames.push(Object.assign(new Image(), {id: `frame${i}`, src: canvas.toDataURL()}));
  }
  document.body.replaceChildren(...frames);
}
