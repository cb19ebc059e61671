// SPDX-License-Identifier: Apache-2.0
import * as THREE from 'three';

const kMoves = ['revolute', 'continuous', 'prismatic'];

// Puts the joints that gaitd does not know of (`fixed` of robot.yaml, <mimic>) where it takes them to be: where
// their range is nearest to zero. `moved`: names of the others, which are drawn as they are measured, beyond their
// limits too.
export function fixJoints(robot, moved) {
  for (const joint of Object.values(robot.joints)) {
    joint.mimicJoints = [];
    joint.ignoreLimits = true;
    if (!kMoves.includes(joint.jointType) || moved.has(joint.urdfName)) continue;
    const {lower, upper} = joint.limit;
    joint.setJointValue(joint.jointType === 'continuous' ? 0 : Math.max(lower, Math.min(upper, 0)));
  }
}

// Puts the robot so that the body whose pose is in the signals is at the origin: `pelvis` of robot.yaml, a link or
// {link, xyz, rpy}, the axes x forward, y left, z up in it. Whatever the file begins with may be elsewhere.
export function rootAtPelvis(robot, pelvis) {
  const {link, xyz = [0, 0, 0], rpy = [0, 0, 0]} = typeof pelvis === 'object' && pelvis ? pelvis : {link: pelvis};
  robot.updateMatrixWorld(true);
  const body = new THREE.Matrix4().makeRotationFromEuler(new THREE.Euler(...rpy.map(Number), 'ZYX'));
  body.setPosition(...xyz.map(Number));
  body.premultiply((robot.links[link] ?? robot).matrixWorld).premultiply(robot.matrixWorld.clone().invert());
  body.invert().decompose(robot.position, robot.quaternion, robot.scale);
}

// Whether joints of `moved`, names, lie between the pelvis and what the file begins with: the robot is put at its
// pelvis again whenever they move.
export function pelvisMoves(robot, pelvis, moved) {
  let at = robot.links[typeof pelvis === 'object' && pelvis ? pelvis.link : pelvis] ?? robot;
  for (; at && at !== robot; at = at.parent) if (moved.has(at.urdfName) && at.isURDFJoint) return true;
  return false;
}
