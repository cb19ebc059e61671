// SPDX-License-Identifier: Apache-2.0
import * as THREE from 'three';

const kFootsteps = 6;  // of the inputs of a log: a command of footsteps
const kColors = {left: '#2ca02c', right: '#ff7f0e'};
const kSole = [[0.12, -0.06], [0.12, 0.06], [-0.12, 0.06], [-0.12, -0.06]];

// Appends the footsteps of an event to `plans`, {time, steps} each, if it is a command of footsteps.
export function appendPlan(plans, {time, kind, text}) {
  if (kind !== 'input' || text?.type !== kFootsteps || !Array.isArray(text.footsteps)) return;
  const steps = text.footsteps.map(({side, position, orientation}) =>
      ({side: side === 0 ? 'left' : 'right', position, orientation}));
  const last = plans.at(-1);
  if (!text.replace && last) last.steps.push(...steps);  // a plan may come in several commands
  else plans.push({time, steps});
}

// The footsteps of the last command that have not been taken.
export class Plan {
  constructor(log) {
    this.log = log;
    this.group = new THREE.Group();
    this.lines = Object.fromEntries(Object.entries(kColors).map(([side, color]) => {
      const line = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({color}));
      line.frustumCulled = false;
      this.group.add(line);
      return [side, line];
    }));
  }

  // Swings count those that were taken since then.
  ahead(time) {
    const {log} = this, plan = log.plans?.findLast((one) => one.time <= time);
    if (!plan || !log.has('gait/step_index')) return [];
    const steps = (at) => log.value('gait/step_index', log.row(at));
    plan.begun ??= steps(plan.time);
    return plan.steps.slice(Math.max(0, steps(time) - plan.begun));
  }

  show(time) {
    const ahead = this.ahead(time), shown = `${ahead.length} ${ahead[0]?.position}`;
    if (shown === this.shown) return;
    this.shown = shown;
    for (const [side, line] of Object.entries(this.lines)) {
      const points = ahead.filter((step) => step.side === side).flatMap(({position, orientation}) => {
        const turn = new THREE.Quaternion(...orientation), middle = new THREE.Vector3(...position);
        const corners = (this.log.robot?.feet?.[side]?.outline ?? kSole).map(([x, y]) =>
            new THREE.Vector3(x, y, 0.005).applyQuaternion(turn).add(middle));
        return corners.flatMap((corner, i) => [corner, corners[(i + 1) % corners.length]]);
      });
      line.visible = points.length > 0;
      line.geometry.dispose();
      line.geometry = new THREE.BufferGeometry().setFromPoints(points);
    }
  }
}
