// SPDX-License-Identifier: Apache-2.0

// Timers and dates that pass only when they are told to; for one test. The one of node:test is not in
// every version of it.
export function fakeClock(t) {
  const timers = new Map(), kNames = ['setTimeout', 'setInterval', 'clearTimeout', 'clearInterval'];
  const real = Object.fromEntries(kNames.map((name) => [name, globalThis[name]])), realNow = Date.now;
  let now = 1e6, last = 0;
  const add = (act, wait, again) => timers.set(++last, {act, at: now + wait, again: again && wait}) && last;
  globalThis.setTimeout = (act, wait) => add(act, wait, false);
  globalThis.setInterval = (act, wait) => add(act, wait, true);
  globalThis.clearTimeout = globalThis.clearInterval = (id) => timers.delete(id);
  Date.now = () => now;
  t.after(() => {
    Object.assign(globalThis, real);
    Date.now = realNow;
  });
  return {tick(milliseconds) {
    const end = now + milliseconds;
    for (;;) {
      const [id, next] = [...timers].sort(([, a], [, b]) => a.at - b.at)[0] ?? [];
      if (!next || next.at > end) break;
      now = next.at;
      if (next.again) next.at += next.again;
      else timers.delete(id);
      next.act();
    }
    now = end;
  }};
}

// node 18 has none.
globalThis.CustomEvent ??= class extends Event {
  constructor(type, {detail}) {
    super(type);
    this.detail = detail;
  }
};
