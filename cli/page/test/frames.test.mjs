// SPDX-License-Identifier: Apache-2.0
// Needs the packages of the page: played where they are installed, in the build tree.
import assert from 'node:assert/strict';
import test from 'node:test';

const packages = await Promise.all([import('three'), import('urdf-loader/src/URDFClasses.js')]).catch(() => undefined);
const skip = packages ? false : 'three.js is not installed here';

// base_footprint -fixed-> pelvis, whose x points to the left -hip (revolute about z)-> leg
// -finger (range from 0.4 up)-> tip, -follower (mimics hip)-> toe
async function made() {
  const [, {URDFRobot, URDFLink, URDFJoint, URDFMimicJoint}] = packages;
  const robot = Object.assign(new URDFRobot(), {links: {}, joints: {}});
  robot.links.base_footprint = robot;
  const add = (name, parent, child, position, type, range, Kind = URDFJoint) => {
    const joint = Object.assign(new Kind(), {urdfName: name, jointType: type});
    joint.axis.set(0, 0, 1);
    joint.position.set(...position);
    Object.assign(joint.limit, range);
    robot.links[parent].add(joint);
    robot.joints[name] = joint;
    joint.add(robot.links[child] = new URDFLink());
    return joint;
  };
  add('base', 'base_footprint', 'pelvis', [0, 0, 1], 'fixed', {});
  const hip = add('hip', 'pelvis', 'leg', [0, 0, -0.5], 'revolute', {lower: -1, upper: 1});
  add('finger', 'leg', 'tip', [0.2, 0, 0], 'revolute', {lower: 0.4, upper: 2});
  const follower = add('follower', 'leg', 'toe', [0.1, 0, 0], 'revolute', {lower: -2, upper: 2}, URDFMimicJoint);
  Object.assign(follower, {mimicJoint: 'hip', multiplier: 2});
  hip.mimicJoints = [follower];
  return robot;
}

test('what gaitd does not move stays where its range is nearest to zero', {skip}, async () => {
  const {fixJoints} = await import('../src/shared/frames.js');
  const robot = await made(), {hip, finger, follower} = robot.joints;
  fixJoints(robot, new Set(['hip']));
  assert.equal(finger.jointValue[0], 0.4);
  hip.setJointValue(1.2);
  assert.equal(hip.jointValue[0], 1.2, 'a joint is drawn where it is, also beyond its limit');
  assert.equal(follower.jointValue[0], 0, 'gaitd takes what mimics for fixed');
});

test('the pelvis of robot.yaml is at the origin, its x forward', {skip}, async () => {
  const {rootAtPelvis} = await import('../src/shared/frames.js');
  const [{Group, Vector3}] = packages;
  const placed = async (pelvis, point, link = 'leg') => {
    const robot = await made(), body = new Group();
    rootAtPelvis(robot, pelvis);
    body.add(robot);
    body.updateMatrixWorld(true);
    return robot.links[link].localToWorld(new Vector3(...point)).toArray().map((v) => Math.round(1e6 * v) / 1e6 + 0);
  };
  assert.deepEqual(await placed('base_footprint', [0, 0, 0]), [0, 0, 0.5]);
  assert.deepEqual(await placed('pelvis', [0, 0, 0]), [0, 0, -0.5]);
  // Forward is the y of the link: what is ahead of the leg by its y is ahead of the robot.
  const turned = {link: 'pelvis', rpy: [0, 0, Math.PI / 2]};
  assert.deepEqual(await placed(turned, [0, 1, 0]), [1, 0, -0.5]);
  assert.deepEqual(await placed(turned, [0, 0, 0], 'base_footprint'), [0, 0, -1]);
  assert.deepEqual(await placed(undefined, [0, 0, 0]), [0, 0, 0.5]);
  assert.deepEqual(await placed({link: 'pelvis', xyz: [0, 0, -0.5]}, [0, 0, 0]), [0, 0, 0]);
});

test('a pelvis below a joint that moves stays at the origin', {skip}, async () => {
  const {pelvisMoves, rootAtPelvis} = await import('../src/shared/frames.js');
  const [{Vector3}] = packages;
  const robot = await made(), moved = new Set(['hip']);
  assert.ok(pelvisMoves(robot, {link: 'leg'}, moved));
  assert.ok(!pelvisMoves(robot, 'pelvis', moved));
  for (const angle of [0, 0.5]) {
    robot.joints.hip.setJointValue(angle);
    rootAtPelvis(robot, 'leg');
    robot.updateMatrixWorld(true);
    const at = (link, point) => robot.links[link].localToWorld(new Vector3(...point)).toArray()
        .map((v) => Math.round(1e6 * v) / 1e6 + 0);
    assert.deepEqual(at('leg', [0.2, 0, 0]), [0.2, 0, 0]);
    assert.deepEqual(at('pelvis', [1, 0, 0]), angle === 0 ? [1, 0, 0.5] : [0.877583, -0.479426, 0.5]);
  }
});
