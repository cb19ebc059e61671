// SPDX-License-Identifier: Apache-2.0
// The standard layout: left stick goes, right stick turns.

const kDead = 0.15;
const kButtons = {1: 'stop', 8: 'estop'};  // the right one of the four, and the one left of the middle

const past = (value = 0) => Math.abs(value) < kDead ? 0 : -Math.sign(value) * (Math.abs(value) - kDead) / (1 - kDead);

// Of a gamepad as the browser gives it; undefined is one that has gone.
export function wantedOf(pad) {
  const [lateral, forward, turn] = (pad?.axes ?? []).map(past);
  return {forward: forward ?? 0, lateral: lateral ?? 0, turn: turn ?? 0};
}

// Gives what has to be called again and again: a browser tells nothing of a gamepad by itself.
export function readGamepads(drive, actions) {
  let pressed = new Set();
  return () => {
    const pad = navigator.getGamepads?.().find((one) => one?.connected);
    drive.want('gamepad', wantedOf(document.hasFocus() ? pad : undefined));
    const now = new Set(Object.keys(kButtons).filter((i) => pad?.buttons[i]?.pressed));
    for (const i of now) if (!pressed.has(i)) actions[kButtons[i]]();
    pressed = now;
  };
}
