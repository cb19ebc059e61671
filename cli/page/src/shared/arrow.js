// SPDX-License-Identifier: Apache-2.0
import * as THREE from 'three';
import {material} from './robot.js';

const kLength = 0.35, kLongest = 1.0;  // m, of weak forces and of strong ones

// A force: its tip is where it acts.
export class Arrow {
  constructor(color) {
    this.group = new THREE.Group();
    this.shaft = new THREE.Mesh(new THREE.CylinderGeometry(0.014, 0.014, 1, 10), material(color));
    this.tip = new THREE.Mesh(new THREE.ConeGeometry(0.04, 0.12, 12), material(color));
    for (const mesh of [this.shaft, this.tip]) {
      mesh.material.depthTest = false;  // an arm must not hide it
      mesh.renderOrder = 1;
      this.group.add(mesh);
    }
    this.group.visible = false;
  }

  // at: m, W. force: N, W. strong: N, from which on the arrow grows no longer.
  place(at, force, strong) {
    const size = force.length();
    const length = kLength + (kLongest - kLength) * Math.min(1, size / strong);
    this.group.position.copy(at);
    this.group.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), force.divideScalar(size || 1));
    this.tip.position.y = -0.06;
    this.shaft.scale.y = length - 0.12;
    this.shaft.position.y = -0.12 - this.shaft.scale.y / 2;
  }
}
