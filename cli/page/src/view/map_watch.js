// SPDX-License-Identifier: Apache-2.0

const kPeriod = 1000;      // ms between two questions
const kResolution = 0.04;  // m, of cells that are asked for

// Asks for the map of the ground again and again; `show` gets it when it has changed.
export class MapWatch {
  constructor(state, call, show) {
    Object.assign(this, {state, call, show, revision: 0, asking: false});
    setInterval(() => this.ask(), kPeriod);
  }

  // Of another gaitd, or of the same after a restart.
  restart() {
    this.revision = 0;
    this.show(undefined);
    this.ask();
  }

  async ask() {
    if (this.asking || document.hidden || !this.state.online || !this.state.connected) return;
    this.asking = true;
    try {
      const map = await this.call('map.get', {resolution: kResolution, since: this.revision});
      if (map?.revision !== this.revision || map?.heights) this.show(map);
      this.revision = map?.revision ?? 0;
    } catch {
      // It is asked for again; an older gaitd has none.
    } finally {
      this.asking = false;
    }
  }
}
