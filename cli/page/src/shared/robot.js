// SPDX-License-Identifier: Apache-2.0
import * as THREE from 'three';
import URDFLoader from 'urdf-loader';
import {fixJoints, pelvisMoves, rootAtPelvis} from './frames.js';
import {addSticks, isBare} from './sticks.js';

export function material(color, opacity = 1) {
  return new THREE.MeshLambertMaterial({color, opacity, transparent: opacity < 1});
}

// Few faces and plain shading: software renderers draw the robot too.
function simplify(robot, opacity) {
  const ball = new THREE.SphereGeometry(1, 16, 10), tube = new THREE.CylinderGeometry(1, 1, 1, 16);
  robot.traverse((mesh) => {
    if (!mesh.isMesh) return;
    if (mesh.geometry.type === 'SphereGeometry') mesh.geometry = ball;
    if (mesh.geometry.type === 'CylinderGeometry') mesh.geometry = tube;
    const {color, opacity: own} = mesh.material;
    if (color) mesh.material = material(color, own * opacity);
  });
}

function parse(urdf, withCollisions) {
  const loader = new URDFLoader();
  loader.parseCollision = withCollisions;
  // Whoever wrote the log chose the addresses of its meshes: nothing is fetched from anywhere.
  loader.loadMeshCb = (path, manager, done) => done(new THREE.Group());
  return loader.parse(urdf);
}

// The robot of a log in its posture.
export class Robot {
  constructor(log, opacity = 1) {
    this.log = log;
    this.pelvis = new THREE.Group();
    this.joints = [];
    if (!log.urdf) return;
    let robot = parse(log.urdf, false);
    if (isBare(robot)) {
      robot = parse(log.urdf, true);
      addSticks(robot, log.robot?.feet);
    }
    simplify(robot, opacity);
    this.links = robot.links;
    this.joints = Object.values(robot.joints)
        .map((joint) => ({joint, signal: `joint/${joint.urdfName}/position`,
                          get column() { return log.column(this.signal); }}))
        .filter(({signal}) => log.has(signal));
    const moved = new Set(this.joints.map(({joint}) => joint.urdfName));
    fixJoints(robot, moved);
    rootAtPelvis(robot, log.robot?.pelvis);
    if (pelvisMoves(robot, log.robot?.pelvis, moved)) this.rootAgain = () => rootAtPelvis(robot, log.robot.pelvis);
    this.pelvis.add(robot);
  }

  show(row) {
    const {log, pelvis} = this;
    const from = log.drawnBy ?? 'pelvis';
    pelvis.position.set(...log.point(from, row));
    pelvis.rotation.set(...['roll', 'pitch', 'yaw'].map((a) => log.value(`${from}/${a}`, row)), 'ZYX');
    for (const {joint, signal} of this.joints) joint.setJointValue(log.value(signal, row));
    this.rootAgain?.();
  }

  // The orientation of a link in the world, likewise.
  turn(link) {
    return (this.links?.[link] ?? this.pelvis).getWorldQuaternion(new THREE.Quaternion());
  }

  // A point of a link in the world; of the pelvis if there is no such link.
  place(link, point) {
    this.pelvis.updateMatrixWorld(true);
    return (this.links?.[link] ?? this.pelvis).localToWorld(new THREE.Vector3(...point));
  }
}
