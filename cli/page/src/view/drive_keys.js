// SPDX-License-Identifier: Apache-2.0

// By their place, which is the same on every keyboard: forward, lateral, turn.
const kKeys = {
  KeyW: [1, 0, 0], KeyS: [-1, 0, 0], KeyA: [0, 0, 1], KeyD: [0, 0, -1], KeyQ: [0, 1, 0], KeyE: [0, -1, 0],
};

// What the keys that are held want.
export class DriveKeys {
  constructor(drive) {
    this.drive = drive;
    this.held = new Set();
  }

  knows(code) { return code in kKeys; }

  // True if it is a key for driving.
  down(code) {
    if (!this.knows(code)) return false;
    this.held.add(code);
    this.tell();
    return true;
  }

  up(code) {
    if (this.held.delete(code)) this.tell();
  }

  release() {
    this.held.clear();
    this.tell();
  }

  tell() {
    const [forward, lateral, turn] = [0, 1, 2].map((axis) =>
        [...this.held].reduce((sum, code) => sum + kKeys[code][axis], 0));
    this.drive.want('keys', {forward, lateral, turn});
  }
}
