// SPDX-License-Identifier: Apache-2.0
import * as THREE from 'three';
import {OrbitControls} from 'three/examples/jsm/controls/OrbitControls.js';
import {HandArrow, Loads, PullArrow} from './forces.js';
import {Ground} from './ground.js';
import {clip, hull} from './hull.js';
import {Plan} from './plan.js';
import {PushArrow} from './push_arrow.js';
import {chooseRenderer} from './renderer.js';
import {material, Robot} from './robot.js';
import {theme} from './theme.js';

const kHands = ['left', 'right'];
export const kMarkers = [
  {name: 'ICP', prefix: 'icp', color: '#d62728'},
  {name: 'planned ICP', prefix: 'icp/desired', color: '#ff9896'},
  {name: 'CMP', prefix: 'cmp/desired', color: '#9467bd'},
  {name: 'CoP', prefix: 'cop', color: '#1f77b4'},
];

const kGhost = 0.3;  // opacity

// ms: where drawing takes less, frames are not late for its sake.
const kShortDrawing = 6;

const kGrid = 0.5;       // m
const kEdge = 1e-3;      // m
const kGridRange = 3.5;  // m, around the robot

// In short pieces: software renderers drop lines that begin behind the camera.
function gridPoints() {
  const points = [], count = 2 * kGridRange / kGrid + 1;
  const range = Array.from({length: count}, (_, i) => -kGridRange + kGrid * i);
  for (const x of range) {
    for (const y of range) {
      if (x < kGridRange) points.push(new THREE.Vector3(x, y, 0), new THREE.Vector3(x + kGrid, y, 0));
      if (y < kGridRange) points.push(new THREE.Vector3(x, y, 0), new THREE.Vector3(x, y + kGrid, 0));
    }
  }
  return points;
}

function terrain(world) {
  const group = new THREE.Group();
  const {boxes = [], height_map, ground_z} = world?.terrain ?? {};
  const ground = ground_z ?? (boxes.length || height_map ? undefined : 0);
  if (ground !== undefined) {
    const plane = new THREE.Mesh(new THREE.PlaneGeometry(40, 40),
                                 new THREE.MeshBasicMaterial({color: theme.ground}));
    plane.position.z = ground - 0.004;  // below the lines on it
    group.add(plane);
    const grid = new THREE.LineSegments(new THREE.BufferGeometry().setFromPoints(gridPoints()),
                                        new THREE.LineBasicMaterial({color: theme.ground_lines}));
    grid.position.z = ground;
    group.grid = grid;
    group.add(grid);
  }
  for (const {center, size, rpy = [0, 0, 0]} of boxes) {
    const box = new THREE.Mesh(new THREE.BoxGeometry(...size), material('#b8b0a0'));
    box.position.set(...center);
    box.rotation.set(...rpy, 'ZYX');
    group.add(box);
  }
  return group;
}

// In place where their count is the same, for it goes to the graphics card with each frame.
function setPoints(geometry, points) {
  const {position} = geometry.attributes;
  if (position?.count !== points.length) {
    geometry.setFromPoints(points);
    return;
  }
  points.forEach((point, i) => position.setXYZ(i, point.x, point.y, point.z));
  position.needsUpdate = true;
}

export class Scene {
  constructor(element, log) {
    this.log = log;
    this.element = element;
    this.renderer = chooseRenderer();
    // More pixels than the screen has smooth the edges, as long as frames are drawn fast enough.
    this.pixels = Math.max(1, devicePixelRatio);
    this.slow = 0;
    this.renderer.setPixelRatio(this.pixels);
    element.append(this.renderer.domElement);
    this.scene = new THREE.Scene();
    this.scene.background = new THREE.Color(theme.sky);
    this.camera = new THREE.PerspectiveCamera(40, 1, 0.05, 100);
    this.camera.up.set(0, 0, 1);
    this.camera.position.set(2.2, -3.2, 1.6);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.addEventListener('change', () => { this.stale = true; });
    const light = new THREE.HemisphereLight('#ffffff', '#777766', 3);
    light.position.set(0.4, -0.5, 0.8);
    this.scene.add(light);
    this.terrain = terrain(log.world);
    this.scene.add(this.terrain);
    this.ground = new Ground();
    this.ground.show(log.ground);
    this.scene.add(this.ground.mesh);
    this.addRobots();
    this.addMarkers();
    this.watcher = new ResizeObserver(() => this.resize());
    this.watcher.observe(element);
    this.resize();
  }

  // For another scene in its place.
  remove() {
    this.watcher.disconnect();
    this.controls.dispose();
    this.renderer.dispose?.();
    this.renderer.forceContextLoss?.();  // a page may have few of them
    this.renderer.domElement.remove();
  }

  // Those of the other logs are ghosts.
  addRobots() {
    this.robots = this.log.all.map((log, i) => new Robot(log, i === 0 ? 1 : kGhost));
    this.arrows = this.robots.map((robot) => new PushArrow(robot));
    for (const {pelvis} of this.robots) this.scene.add(pelvis);
    this.forces = this.robots.flatMap((robot) => [new Loads(robot), new PullArrow(robot),
      ...kHands.map((side) => new HandArrow(robot, side))]);
    for (const {group} of [...this.arrows, ...this.forces]) this.scene.add(group);
    [{pelvis: this.pelvis, joints: this.joints}] = this.robots;
  }

  addMarkers() {
    this.markers = kMarkers.filter(({prefix}) => this.log.has(`${prefix}/x`))
        .map(({prefix, color}) => {
          const mesh = new THREE.Mesh(new THREE.SphereGeometry(0.018, 12, 8), material(color));
          mesh.material.depthTest = false;  // a foot must not hide them
          mesh.renderOrder = 1;
          this.scene.add(mesh);
          return {prefix, mesh};
        });
    this.footsteps = {};
    for (const side of ['left', 'right']) {
      const line = new THREE.LineLoop(new THREE.BufferGeometry(), new THREE.LineBasicMaterial(
          {color: side === 'left' ? '#2ca02c' : '#ff7f0e'}));
      line.frustumCulled = false;  // three.js would ask where it was at first
      this.footsteps[side] = line;
      this.scene.add(line);
    }
    this.plan = new Plan(this.log);
    this.scene.add(this.plan.group);
    this.support = new THREE.Mesh(new THREE.BufferGeometry(), new THREE.MeshBasicMaterial(
        {color: '#1f77b4', opacity: 0.25, transparent: true, side: THREE.DoubleSide}));
    this.support.frustumCulled = false;
    this.scene.add(this.support);
  }

  // The time of the row of each log at that time: what the scene shows.
  rowsAt(time) {
    return this.log.all.map((one) => one.time[one.row(time)]).join();
  }

  // Only what has changed is drawn again.
  update(time) {
    if (this.rowsAt(time) !== this.rows) this.show(time);
    else if (this.stale) this.draw();
  }

  // Fewer pixels where frames of `milliseconds` come too slowly.
  adapt(milliseconds) {
    const late = milliseconds > 22 && !(this.renderer.milliseconds < kShortDrawing);
    this.slow = Math.max(0, this.slow + (late ? 1 : -1));
    if (this.slow < 20 || this.pixels < 0.4) return;
    this.slow = 0;
    this.pixels *= 0.7;
    this.renderer.setPixelRatio(this.pixels);
    this.stale = true;
  }

  draw() {
    this.stale = false;
    this.beforeDraw?.();
    this.renderer.render(this.scene, this.camera);
  }

  resize() {
    const {clientWidth: width, clientHeight: height} = this.element;
    this.renderer.setSize(width, height);
    this.camera.aspect = width / Math.max(1, height);
    this.camera.updateProjectionMatrix();
    this.stale = true;
  }

  // m, in the frame of the sole.
  sole(side) {
    return this.log.robot?.feet?.[side]?.outline ??
        [[0.12, -0.06], [0.12, 0.06], [-0.12, 0.06], [-0.12, -0.06]];
  }

  // What of its sole a foot is seen to bear on. A log of before those signals does not tell.
  bears(side, row) {
    const reach = (name) => this.log.value(`foot/${side}/bears/${name}`, row);
    const [back, front, right, left] = ['back', 'front', 'right', 'left'].map(reach);
    const part = Number.isFinite(front) ? clip(this.sole(side), {
      back: back - kEdge, front: front + kEdge, right: right - kEdge, left: left + kEdge,
    }) : this.sole(side);
    if (this.log.word(`foot/${side}/contact`, row) !== 'toe') return part;
    const toe = Math.max(...part.map(([x]) => x)) - 2 * kEdge;
    return part.filter(([x]) => x > toe);
  }

  // Corners in the world of a part of a sole. `pose`: the log's foot (with roll and pitch) or footstep.
  corners(part, side, pose, row) {
    const matrix = new THREE.Matrix4();
    const angle = (name) => this.log.value(`${pose}/${side}/${name}`, row) || 0;
    matrix.makeRotationFromEuler(
        new THREE.Euler(angle('roll'), angle('pitch'), angle('yaw'), 'ZYX'));
    matrix.setPosition(...this.log.point(`${pose}/${side}`, row));
    return part.map(([x, y]) => new THREE.Vector3(x, y, 0).applyMatrix4(matrix));
  }

  show(time) {
    const {log} = this, row = log.row(time);
    for (const robot of this.robots) robot.show(robot.log.row(time));
    for (const arrow of this.arrows) arrow.show(time);
    for (const force of this.forces) force.show(force.robot.log.row(time));
    this.plan.show(time);
    const loaded = [];
    for (const side of ['left', 'right']) {
      setPoints(this.footsteps[side].geometry, this.corners(this.sole(side), side, 'footstep', row));
      if (log.word(`foot/${side}/contact`, row) === 'none') continue;
      loaded.push(...this.corners(this.bears(side, row), side, 'foot', row));
    }
    this.support.visible = loaded.length > 2;
    if (this.support.visible) {
      const corners = hull(loaded);
      setPoints(this.support.geometry,
                corners.slice(2).flatMap((corner, i) => [corners[0], corners[i + 1], corner]));
    }
    const ground = loaded.length ? Math.max(...loaded.map(({z}) => z)) : 0;
    for (const {prefix, mesh} of this.markers) {
      mesh.position.set(log.value(`${prefix}/x`, row), log.value(`${prefix}/y`, row), ground);
    }
    this.rows = this.rowsAt(time);
    this.follow();
    this.draw();
  }

  // The camera keeps its place beside the robot.
  follow() {
    const target = this.pelvis.position.clone();
    if (!Number.isFinite(target.lengthSq())) return;  // not known yet
    target.z -= 0.15;
    const {grid} = this.terrain;
    if (grid) {
      grid.position.x = kGrid * Math.round(target.x / kGrid);
      grid.position.y = kGrid * Math.round(target.y / kGrid);
    }
    this.camera.position.add(target).sub(this.controls.target);
    this.controls.target.copy(target);
    this.controls.update();
  }
}
