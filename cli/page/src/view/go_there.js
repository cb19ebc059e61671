// SPDX-License-Identifier: Apache-2.0
import * as THREE from 'three';
import {material} from '../shared/robot.js';
import {$, enable, say} from '../shared/dom.js';
import {told} from './toast.js';

const kLeastDrag = 0.15;  // m, from which a drag says where to look at the end
const kPlan = 60;         // s, that a plan may take

// A place on the ground by a click, with the heading by a drag, once after the button was pressed.
export class GoThere {
  constructor(state, call) {
    Object.assign(this, {state, call, active: false});
    $('goto').addEventListener('click', () => this.toggle(!this.active));
    state.addEventListener('change', () => {
      const obstacle = state.obstacle('goto');
      enable($('goto'), obstacle, 'Then click where to go; drag to say where to look at the end');
      if (obstacle) this.toggle(false);
    });
  }

  toggle(active) {
    this.active = active;
    this.from = undefined;
    $('goto').setAttribute('aria-pressed', active);
    if (this.mark) this.mark.visible = false;
    if (this.scene) {
      this.scene.element.style.cursor = active ? 'crosshair' : '';
      this.scene.stale = true;
    }
  }

  // On the scene of another robot.
  attach(scene) {
    this.ears?.abort();
    this.scene = scene;
    this.ears = new AbortController();
    this.ray = new THREE.Raycaster();
    this.mark = new THREE.Group();
    const ring = new THREE.Mesh(new THREE.RingGeometry(0.1, 0.14, 24), material('#d62728'));
    this.hand = new THREE.Mesh(new THREE.PlaneGeometry(0.4, 0.03).translate(0.2, 0, 0), material('#d62728'));
    for (const mesh of [ring, this.hand]) {
      mesh.material.side = THREE.DoubleSide;
      mesh.material.depthTest = false;
      mesh.renderOrder = 2;
      this.mark.add(mesh);
    }
    this.mark.visible = false;
    scene.scene.add(this.mark);
    const on = (type, act) => scene.element.addEventListener(type, (event) => {
      if (this.active && event.isPrimary && act(event)) {
        event.stopPropagation();
        event.preventDefault();
      }
    }, {capture: true, signal: this.ears.signal});
    on('pointerdown', (event) => event.button === 0 && this.begin(event));
    on('pointermove', (event) => this.turn(event));
    on('pointerup', (event) => this.end(event));
    on('pointercancel', () => this.toggle(false));
  }

  // m, W: on what is known of the ground, or at the height of the feet.
  ground({clientX, clientY}) {
    const {element, camera, ground, log} = this.scene;
    const {left, top, width, height} = element.getBoundingClientRect();
    this.ray.setFromCamera(new THREE.Vector2(2 * (clientX - left) / width - 1,
                                             1 - 2 * (clientY - top) / height), camera);
    const [hit] = ground.mesh.visible ? this.ray.intersectObject(ground.mesh) : [];
    if (hit) return hit.point;
    const level = Math.min(log.newest('foot/left/z'), log.newest('foot/right/z')) || 0;
    return this.ray.ray.intersectPlane(new THREE.Plane(new THREE.Vector3(0, 0, 1), -level), new THREE.Vector3());
  }

  begin(event) {
    this.from = this.ground(event) ?? undefined;
    if (!this.from) return false;
    this.scene.element.setPointerCapture(event.pointerId);
    this.mark.position.copy(this.from);
    this.mark.visible = true;
    this.hand.visible = false;
    this.yaw = undefined;
    this.scene.stale = true;
    return true;
  }

  turn(event) {
    if (!this.from) return true;  // the camera stays where it is
    const to = this.ground(event);
    const [x, y] = to ? [to.x - this.from.x, to.y - this.from.y] : [0, 0];
    this.yaw = Math.hypot(x, y) > kLeastDrag ? Math.atan2(y, x) : undefined;
    this.hand.visible = this.yaw !== undefined;
    this.mark.rotation.z = this.yaw ?? 0;
    this.scene.stale = true;
    return true;
  }

  end() {
    if (!this.from) return false;
    const {x, y} = this.from, params = {x, y};
    if (this.yaw !== undefined) params.yaw = this.yaw;
    this.toggle(false);
    told(`Go to ${x.toFixed(2)}, ${y.toFixed(2)}`, this.call('goto', params, kPlan));
    return true;
  }
}
