// SPDX-License-Identifier: Apache-2.0
import * as THREE from 'three';
import {material} from './robot.js';
import {kPushColor} from './theme.js';

const kShortest = 0.4;  // s, for which a push is seen
const kLength = 0.35, kLongest = 1.0;  // m, of weak pushes and of the strongest
const kStrong = 1500;  // N

// Whether the arrow of a push is there at that time.
export const isShown = ({time, duration}, now) =>
    now >= time && now <= time + Math.max(duration, kShortest);

// An arrow for the pushes of a robot: its tip is where the force acts.
export class PushArrow {
  constructor(robot) {
    this.robot = robot;
    this.group = new THREE.Group();
    this.shaft = new THREE.Mesh(new THREE.CylinderGeometry(0.014, 0.014, 1, 10), material(kPushColor));
    this.tip = new THREE.Mesh(new THREE.ConeGeometry(0.04, 0.12, 12), material(kPushColor));
    for (const mesh of [this.shaft, this.tip]) {
      mesh.material.depthTest = false;  // an arm must not hide it
      mesh.renderOrder = 1;
      this.group.add(mesh);
    }
    this.group.visible = false;
  }

  show(now) {
    const push = this.robot.log.pushes.find((one) => isShown(one, now));
    this.group.visible = push !== undefined;
    if (push) this.place(push);
  }

  place(push) {
    const force = new THREE.Vector3(...push.force), size = force.length();
    const length = kLength + (kLongest - kLength) * Math.min(1, size / kStrong);
    this.group.position.copy(this.robot.place(push.push, push.point));
    this.group.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), force.divideScalar(size || 1));
    this.tip.position.y = -0.06;
    this.shaft.scale.y = length - 0.12;
    this.shaft.position.y = -0.12 - this.shaft.scale.y / 2;
  }
}
