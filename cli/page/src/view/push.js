// SPDX-License-Identifier: Apache-2.0
import * as THREE from 'three';
import {PushArrow} from '../shared/push_arrow.js';
import {say} from '../shared/dom.js';
import {refused} from './refused.js';
import {springForce} from './spring.js';

const kPeriod = 50;      // ms between the parts of a push
const kDuration = 0.08;  // s, of each: they overlap
const kUnanswered = 4;
const kWeakest = 5;      // N

// The link a mesh belongs to, of those that move: gaitd pushes no other ones.
function linkOf(mesh) {
  for (let one = mesh; one; one = one.parent) {
    if (!one.isURDFLink) continue;
    const joint = one.parent;
    if (!joint?.isURDFJoint || joint.jointType !== 'fixed') return one;
  }
  return undefined;
}

// Who drags a link of the robot pulls at it as by a spring, in the plane that faces the camera. Elsewhere
// the mouse turns the camera, as ever.
export class Push {
  constructor(scene, {call, congested, allowed, tell, label}) {
    Object.assign(this, {scene, call, congested, allowed, tell, label, unanswered: 0});
    this.ray = new THREE.Raycaster();
    this.arrow = new PushArrow(scene.robots[0]);
    scene.scene.add(this.arrow.group);
    const {element} = scene;
    this.ears = new AbortController();
    const on = (type, act, capture) => element.addEventListener(type, act, {capture, signal: this.ears.signal});
    on('pointerdown', (event) => this.grab(event), true);  // before the camera has it
    on('pointermove', (event) => this.hover(event));
    for (const type of ['pointerup', 'pointercancel']) on(type, (event) => this.letGo(event), true);
    on('pointermove', (event) => this.drag(event), true);
  }

  remove() {
    this.release();
    this.ears.abort();
  }

  aim({clientX, clientY}) {
    const {left, top, width, height} = this.scene.element.getBoundingClientRect();
    this.ray.setFromCamera(new THREE.Vector2(2 * (clientX - left) / width - 1,
                                             1 - 2 * (clientY - top) / height), this.scene.camera);
    return this.ray.ray;
  }

  hit(event) {
    if (!this.allowed()) return undefined;
    this.aim(event);
    const [first] = this.ray.intersectObject(this.scene.pelvis, true);
    const link = first && linkOf(first.object);
    return link && {link, point: link.worldToLocal(first.point.clone())};
  }

  hover(event) {
    if (this.grabbed || event.buttons || event.pointerType === 'touch') return;
    this.scene.element.style.cursor = this.hit(event) ? 'grab' : '';
  }

  grab(event) {
    if (this.grabbed || event.button > 0 || !event.isPrimary) return;
    this.grabbed = this.hit(event);
    if (!this.grabbed) return;
    event.stopPropagation();
    event.preventDefault();
    this.pointer = {id: event.pointerId, clientX: event.clientX, clientY: event.clientY};
    this.scene.element.setPointerCapture(event.pointerId);
    this.refused = false;
    this.timer = setInterval(() => this.send(), kPeriod);
  }

  drag(event) {
    if (event.pointerId !== this.pointer?.id) return;
    event.stopPropagation();
    Object.assign(this.pointer, {clientX: event.clientX, clientY: event.clientY});
  }

  letGo(event) {
    if (event.pointerId === this.pointer?.id) this.release();
  }

  release() {
    clearInterval(this.timer);
    this.grabbed = this.pointer = undefined;
    this.arrow.group.visible = false;
    this.scene.stale = true;
    this.label.hidden = true;
  }

  // Where the pointer is in the plane through the point that faces the camera: camera and robot move.
  force() {
    const {link, point} = this.grabbed, at = link.localToWorld(point.clone());
    const plane = new THREE.Plane().setFromNormalAndCoplanarPoint(
        this.scene.camera.getWorldDirection(new THREE.Vector3()), at);
    const target = this.aim(this.pointer).intersectPlane(plane, new THREE.Vector3());
    return target ? springForce(at.toArray(), target.toArray()) : [0, 0, 0];
  }

  // Of each frame, before it is drawn: the arrow. The one of the pushes that gaitd reports would be late.
  show() {
    const {arrow, scene: {arrows: [reported]}} = this;
    if (!this.grabbed) return;
    const force = this.force(), size = Math.hypot(...force);
    reported.group.visible = false;
    arrow.group.visible = size >= kWeakest;
    if (arrow.group.visible) {
      arrow.point({push: this.grabbed.link.urdfName, point: this.grabbed.point.toArray(), force});
    }
    this.label.hidden = false;
    say(this.label, `${this.grabbed.link.urdfName}: ${size.toFixed(0)} N`);
    this.scene.stale = true;
  }

  async send() {
    const force = this.force();
    if (this.refused || Math.hypot(...force) < kWeakest) return;
    if (this.unanswered >= kUnanswered || this.congested()) return;
    ++this.unanswered;
    try {
      await this.call('sim.push', {link: this.grabbed.link.urdfName, force, duration: kDuration,
                                   point: this.grabbed.point.toArray()});
    } catch (error) {
      if (!this.refused) this.tell(refused('sim.push', error), true);
      this.refused = true;  // until it is grabbed again
    } finally {
      --this.unanswered;
    }
  }
}
