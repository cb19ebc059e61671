// SPDX-License-Identifier: Apache-2.0
import {make} from '../shared/dom.js';

const kDead = 0.08;  // share of the way that counts as none

const past = (share) => Math.abs(share) < kDead ? 0 : Math.sign(share) * (Math.abs(share) - kDead) / (1 - kDead);

// A knob in `pad` that follows a finger or the mouse while it is held, and springs back. `moved(x, y,
// shift)`: shares from -1 to 1, right and up; zeros when it is let go.
function knob(pad, moved) {
  const mark = make('i');
  pad.append(mark);
  let holder;
  const place = (x, y) => { mark.style.transform = `translate(${x}px, ${y}px)`; };
  const follow = (event) => {
    const {left, top, width, height} = pad.getBoundingClientRect(), half = Math.max(width, height) / 2;
    let x = (event.clientX - left - width / 2) / half, y = (event.clientY - top - height / 2) / half;
    if (width > 2 * height) y = 0;
    const length = Math.max(1, Math.hypot(x, y));
    x /= length;
    y /= length;
    const reach = 0.72 * half;
    place(reach * x, reach * y);
    moved(past(x), past(-y), event.shiftKey);
  };
  const release = () => {
    if (holder === undefined) return;
    holder = undefined;
    place(0, 0);
    pad.classList.remove('held');
    moved(0, 0, false);
  };
  pad.addEventListener('pointerdown', (event) => {
    if (holder !== undefined || pad.classList.contains('off') || event.button > 0) return;
    event.preventDefault();
    holder = event.pointerId;
    pad.setPointerCapture(holder);
    pad.classList.add('held');
    follow(event);
  });
  pad.addEventListener('pointermove', (event) => event.pointerId === holder && follow(event));
  for (const type of ['pointerup', 'pointercancel', 'lostpointercapture']) {
    pad.addEventListener(type, (event) => event.pointerId === holder && release());
  }
  return release;
}

// Forwards and turn, with Shift sideways in place of the turn; the strip below is sideways alone.
// Gives what lets both go.
export function addStick(pad, strip, drive) {
  const releases = [
    knob(pad, (x, y, shift) => drive.want('stick',
        {forward: y, lateral: shift ? -x : 0, turn: shift ? 0 : -x})),
    knob(strip, (x) => drive.want('strip', {forward: 0, lateral: -x, turn: 0})),
  ];
  return () => releases.forEach((release) => release());
}
