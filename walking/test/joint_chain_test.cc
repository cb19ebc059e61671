// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/joint_chain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "gaitd/dynamics/kinematics.h"
#include "gaitd/sdk/views.h"
#include "walking/test/allocation_counter.h"
#include "walking/test/synthetic_walk.h"

namespace gaitd::walking {
namespace {

using testing::atlas;

JointChain::Joints drawn(const JointChain& arm, std::mt19937* random) {
  JointChain::Joints q = arm.nominal();
  for (int i = 0; i < arm.size(); ++i) {
    q[i] = std::uniform_real_distribution(arm.least(i), arm.most(i))(*random);
  }
  return q;
}

TEST(JointChain, TheHandIsWhereTheKinematicsOfTheRobotSay) {
  std::mt19937 random(1);
  dynamics::Kinematics robot(atlas());
  for (int hand = 0; hand < GAITD_MAX_HANDS; ++hand) {
    const JointChain arm = JointChain::arm(atlas(), hand);
    ASSERT_EQ(arm.size(), 7);
    const JointChain::Joints q = drawn(arm, &random), qd = drawn(arm, &random);
    Eigen::VectorXd all = Eigen::VectorXd::Zero(atlas().joint_count), rates = all;
    for (int i = 0; i < arm.size(); ++i) {
      all[arm.joint(i)] = q[i];
      rates[arm.joint(i)] = qd[i];
    }
    robot.update({0, 0, 1}, Eigen::Quaterniond::Identity(), sdk::Vector6d::Zero(), all, rates);
    const GaitdFrame& frame = atlas().hands[hand];
    const Eigen::Isometry3d chest = robot.X_WB(atlas().chest_body);
    const Eigen::Vector3d place =
        chest.inverse() * robot.frame_position(frame.body, sdk::view(frame.origin));
    EXPECT_LT((arm.pose(q).position - place).norm(), 1e-12);
    const JointChain::Twist twist = arm.jacobian(q) * qd;
    const sdk::Vector6d expected = robot.frame_velocity(frame.body, sdk::view(frame.origin));
    EXPECT_LT((chest.linear() * twist.head<3>() - expected.head<3>()).norm(), 1e-10);
    EXPECT_LT((chest.linear() * twist.tail<3>() - expected.tail<3>()).norm(), 1e-10);
  }
}

TEST(JointChain, FindsWhatIsInReach) {
  std::mt19937 random(2);
  const JointChain arm = JointChain::arm(atlas(), GAITD_LEFT);
  int found = 0;
  constexpr int kGoals = 200;
  for (int i = 0; i < kGoals; ++i) {
    // A goal near the nominal posture that is certainly in reach.
    JointChain::Joints q = arm.nominal();
    for (int k = 0; k < arm.size(); ++k) {
      q[k] = std::clamp(q[k] + std::uniform_real_distribution(-0.6, 0.6)(random), arm.least(k),
                        arm.most(k));
    }
    const JointChain::Pose goal = arm.pose(q);
    JointChain::Joints solved = arm.nominal();
    const JointChain::Miss miss = arm.reach(goal, 40, solved);
    for (int k = 0; k < arm.size(); ++k) {
      EXPECT_GE(solved[k], arm.least(k) - 1e-12);
      EXPECT_LE(solved[k], arm.most(k) + 1e-12);
    }
    if (miss.position < 1e-3 && miss.turn < 3e-3) ++found;
  }
  EXPECT_GE(found, kGoals * 95 / 100);
}

TEST(JointChain, ComesAsNearAsItCanToWhatIsOutOfReach) {
  const JointChain arm = JointChain::arm(atlas(), GAITD_LEFT);
  JointChain::Pose goal = arm.pose(arm.nominal());
  goal.position += Eigen::Vector3d(3.0, 0.0, 0.0);
  JointChain::Joints q = arm.nominal();
  const JointChain::Miss miss = arm.reach(goal, 100, q);
  EXPECT_GT(miss.position, 1.5);
  EXPECT_LT(miss.position, 2.9);
  EXPECT_TRUE(q.allFinite());
}

TEST(JointChain, AStepKeepsItsBoundsAndTheHeap) {
  std::mt19937 random(3);
  const JointChain arm = JointChain::arm(atlas(), GAITD_RIGHT);
  const JointChain::Pose goal = arm.pose(drawn(arm, &random));
  JointChain::Joints q = arm.nominal();
  const int before = testing::allocation_count();
  for (int i = 0; i < 200; ++i) {
    const JointChain::Joints last = q;
    arm.step(goal, JointChain::Joints::Constant(arm.size(), 0.01), 0.001, q);
    EXPECT_LE((q - last).cwiseAbs().maxCoeff(), 0.01 + 1e-12);
  }
  EXPECT_EQ(testing::allocation_count(), before);
}

TEST(JointChain, TheSpineTurnsTheChest) {
  const JointChain spine = JointChain::spine(atlas());
  ASSERT_EQ(spine.size(), 3);
  JointChain::Pose goal = spine.pose(spine.nominal());
  goal.orientation = sdk::from_roll_pitch_yaw(0.1, 0.2, 0.3) * goal.orientation;
  JointChain::Joints q = spine.nominal();
  EXPECT_LT(spine.reach(goal, 40, q).turn, 1e-4);
}

}  // namespace
}  // namespace gaitd::walking
