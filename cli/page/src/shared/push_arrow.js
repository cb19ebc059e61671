// SPDX-License-Identifier: Apache-2.0
import * as THREE from 'three';
import {Arrow} from './arrow.js';
import {kPushColor} from './theme.js';

const kShortest = 0.4;  // s, for which a push is seen
const kStrong = 1500;   // N

// Whether the arrow of a push is there at that time.
export const isShown = ({time, duration}, now) =>
    now >= time && now <= time + Math.max(duration, kShortest);

// An arrow for the pushes of a robot.
export class PushArrow extends Arrow {
  constructor(robot) {
    super(kPushColor);
    this.robot = robot;
  }

  show(now) {
    const push = this.robot.log.pushes.find((one) => isShown(one, now));
    this.group.visible = push !== undefined;
    if (push) this.point(push);
  }

  point(push) {
    this.place(this.robot.place(push.push, push.point), new THREE.Vector3(...push.force), kStrong);
  }
}
