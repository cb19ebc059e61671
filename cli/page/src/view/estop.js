// SPDX-License-Identifier: Apache-2.0

const kAgain = 500, kLongest = 10000;  // ms

// Asks for an e-stop until gaitd has taken it: each request on its own, none waits for another one, and
// one that found no connection is sent when there is one again. `tell(text, bad)` says how it went.
export class EStop {
  constructor(call, tell) {
    Object.assign(this, {call, tell, began: undefined});
  }

  press() {
    this.began = Date.now();
    this.taken = false;
    this.complained = false;
    this.ask();
  }

  // Of the connection: it is there (again).
  online() {
    if (this.pending) this.ask();
  }

  get pending() { return this.began !== undefined && !this.taken; }

  ask() {
    clearTimeout(this.timer);
    if (Date.now() > this.began + kLongest) {
      this.began = undefined;
      this.tell('E-STOP WAS NOT TAKEN. Use the one on the robot.', true);
      return;
    }
    this.timer = setTimeout(() => this.pending && this.ask(), kAgain);
    this.call('estop', undefined, 5).then((result) => {
      if (!this.pending) return;
      this.taken = true;
      clearTimeout(this.timer);
      this.tell(`E-stop taken at tick ${result?.tick}. Then: reset, arm.`, false);
    }, (error) => {
      if (this.complained || !this.pending) return;
      this.complained = true;
      this.tell(`E-STOP NOT TAKEN YET: ${error.message}. Use the one on the robot.`, true);
    });
  }
}
