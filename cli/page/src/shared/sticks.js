// SPDX-License-Identifier: Apache-2.0
// A figure of sticks for robots whose links are drawn by meshes, which are never loaded, or by
// nothing: from each joint to those that hang on it.
import * as THREE from 'three';

const kThick = 0.1, kThinnest = 0.008, kThickest = 0.04;  // of the length, m, m
const kShortest = 0.005;  // m
const kSole = 0.015;  // m, its thickness
const kColor = 0x8a94a0;

const joints = (link) => link.children.filter((child) => child.isURDFJoint);

function isDrawn(part) {
  return part.isMesh || part.children.some((child) => !child.isURDFJoint && isDrawn(child));
}

function movingLinks(robot) {
  return Object.values(robot.joints).filter((joint) => joint.jointType !== 'fixed')
      .flatMap((joint) => joint.children.filter((child) => child.isURDFLink));
}

// Whether less than half of the links that move are drawn.
export function isBare(robot) {
  const links = movingLinks(robot);
  return 2 * links.filter(isDrawn).length < links.length;
}

const part = (geometry) => new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({color: kColor}));

// From the frame of a link to `end` in it.
function stick(end) {
  const length = end.length();
  const radius = Math.min(kThickest, Math.max(kThinnest, kThick * length));
  const mesh = part(new THREE.CylinderGeometry(1, 1, 1, 16));
  mesh.scale.set(radius, length, radius);
  mesh.position.copy(end).multiplyScalar(0.5);
  mesh.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), end.clone().normalize());
  return mesh;
}

// The sole of a foot of robot.yaml, in the link that carries it.
function slab({sole, outline}) {
  const shape = new THREE.Shape(outline.map(([x, y]) => new THREE.Vector2(x, y)));
  const mesh = part(new THREE.ExtrudeGeometry(shape, {depth: kSole, bevelEnabled: false}));
  mesh.position.set(...sole?.xyz ?? [0, 0, 0]);
  mesh.rotation.set(...sole?.rpy ?? [0, 0, 0], 'ZYX');
  return mesh;
}

// `feet`: of robot.yaml, if it is known.
export function addSticks(robot, feet) {
  robot.traverse((child) => {
    if (child.isURDFCollider) child.traverse((mesh) => mesh.material?.color?.set(kColor));
  });
  for (const foot of Object.values(feet ?? {})) {
    const link = robot.links[foot.link];
    if (link && foot.outline && !isDrawn(link)) link.add(slab(foot));
  }
  for (const link of Object.values(robot.links)) {
    if (isDrawn(link)) continue;
    for (const joint of joints(link)) {
      const end = joint.position.clone();
      if (end.length() > kShortest && leadsOn(joint)) link.add(stick(end));
    }
  }
}

// Frames of sensors and tools hang on fixed joints with nothing behind them: no part of the figure.
function leadsOn(joint) {
  return joint.jointType !== 'fixed' || joint.children.some(
      (child) => child.isURDFLink && joints(child).some(leadsOn));
}
