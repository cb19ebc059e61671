// SPDX-License-Identifier: Apache-2.0
// What a robot carries, as boxes, and what pulls at it and pushes its hands, as arrows.
import * as THREE from 'three';
import {Arrow} from './arrow.js';
import {material} from './robot.js';
import {kLoadColor, kPullColor} from './theme.js';

const kSlots = [0, 1, 2, 3];
const kDensity = 400;  // kg/m^3, of a box that is drawn for a load
const kStrong = 400;   // N

export class Loads {
  constructor(robot) {
    this.robot = robot;
    this.group = new THREE.Group();
    this.boxes = kSlots.filter((i) => robot.log.has(`payload/${i}/mass`)).map((i) => {
      const mesh = new THREE.Mesh(new THREE.BoxGeometry(1, 1, 1), material(kLoadColor, 0.6));
      this.group.add(mesh);
      return {prefix: `payload/${i}`, mesh};
    });
  }

  show(row) {
    const {log} = this.robot;
    for (const {prefix, mesh} of this.boxes) {
      const mass = log.value(`${prefix}/mass`, row);
      mesh.visible = mass > 0;
      if (!mesh.visible) continue;
      const link = log.word(`${prefix}/link`, row);
      mesh.position.copy(this.robot.place(link, log.point(`${prefix}/com`, row)));
      mesh.quaternion.copy(this.robot.turn(link));
      mesh.scale.setScalar(Math.cbrt(mass / kDensity));
    }
  }
}

// At the centre of mass, while the controller counts on the pull.
export class PullArrow extends Arrow {
  constructor(robot) {
    super(kPullColor);
    this.robot = robot;
  }

  show(row) {
    const {log} = this.robot;
    this.group.visible = log.value('external/pulled', row) === 1;
    if (!this.group.visible) return;
    const [x, y] = log.point('external/force', row);
    this.place(new THREE.Vector3(...log.point('com', row)), new THREE.Vector3(x, y, 0), kStrong);
  }
}

// Of a hand that holds on: what it is pushed with, as the controller plans it.
export class HandArrow extends Arrow {
  constructor(robot, side) {
    super(kPullColor);
    this.robot = robot;
    this.prefix = `handhold/${side}`;
    this.known = robot.log.has(`${this.prefix}/force_max`);
  }

  show(row) {
    const {log} = this.robot;
    this.group.visible = this.known && log.value(`${this.prefix}/force_max`, row) > 0;
    if (!this.group.visible) return;
    const force = new THREE.Vector3(...log.point(`${this.prefix}/force_desired`, row));
    this.place(new THREE.Vector3(...log.point(this.prefix, row)), force, kStrong);
  }
}
