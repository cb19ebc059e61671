// SPDX-License-Identifier: Apache-2.0
// The standard layout of https://www.w3.org/TR/gamepad: left stick goes, right stick turns.

import {isZero} from './drive.js';

const kDead = 0.15;
const kButtons = {1: 'stop', 8: 'estop'};  // the right one of the four, and the one left of the middle

const past = (value = 0) => Math.abs(value) < kDead ? 0 : -Math.sign(value) * (Math.abs(value) - kDead) / (1 - kDead);

// Of a gamepad as the browser gives it; undefined is one that has gone.
export function wantedOf(pad) {
  const [lateral, forward, turn] = (pad?.axes ?? []).map(past);
  return {forward: forward ?? 0, lateral: lateral ?? 0, turn: turn ?? 0};
}

// Gives {read(), to be called again and again: a browser tells nothing of a gamepad by itself; release()}.
// Only of pads whose layout the browser knows: on others an axis may be a trigger, which rests at its end.
// And only from when they were seen at rest, while the page has the focus and since it was let go.
export function readGamepads(drive, actions, source = navigator) {
  let pressed = new Set(), rested;
  const read = () => {
    const pad = source.getGamepads?.().find((one) => one?.connected && one.mapping === 'standard');
    const wanted = wantedOf(pad);
    if (!document.hasFocus()) rested = undefined;
    else if (isZero(wanted)) rested = pad?.index;
    drive.want('gamepad', pad && rested === pad.index ? wanted : wantedOf(undefined));
    const now = new Set(Object.keys(kButtons).filter((i) => pad?.buttons[i]?.pressed));
    for (const i of now) if (!pressed.has(i)) actions[kButtons[i]]();
    pressed = now;
  };
  return {read, release: () => { rested = undefined; }};
}
