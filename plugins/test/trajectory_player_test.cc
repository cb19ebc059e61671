// SPDX-License-Identifier: Apache-2.0
#include "trajectory_player.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "gaitd/sdk/chain.h"
#include "gaitd/sdk/views.h"
#include "layer_inputs.h"

namespace gaitd::plugins {
namespace {

using testing::atlas;
using testing::SyntheticWalk;
using walking::JointChain;

class TrajectoryPlayerTest : public ::testing::Test {
 protected:
  TrajectoryPlayerTest() {
    walk_.machine.set_mode(GAITD_MODE_WALK_BENT);
    walk_.tick();
  }
  GaitdMotion& ask(int part, int kind, std::uint32_t mask, double time) {
    GaitdMotion& motion = motions_.parts[part];
    motion = {};
    motion.id = ++last_id_;
    motion.kind = kind;
    motion.axis_mask = mask;
    motion.point_count = 1;
    motion.points[0].time = time;
    return motion;
  }
  GaitdTaskReferences tick(TrajectoryPlayer& player) {
    const GaitdTaskSourceInput in{
        sizeof(in), 0, testing::layer_time(walk_.dt), &walk_.robot, &walk_.gait(), &motions_};
    GaitdTaskReferences out;
    std::memset(&out, 0x55, sizeof(out));  // whatever stood there before
    EXPECT_EQ(player.process(in, out), GAITD_OK);
    return out;
  }
  GaitdTaskReferences run(double seconds) {
    GaitdTaskReferences out = tick(player_);
    for (int i = 1; i < static_cast<int>(seconds / walk_.dt + 0.5); ++i) out = tick(player_);
    return out;
  }

  SyntheticWalk walk_;
  GaitdMotions motions_{sizeof(GaitdMotions), 0, {}};
  TrajectoryPlayer player_{atlas()};
  std::uint32_t last_id_ = 0;
};

TEST_F(TrajectoryPlayerTest, NothingIsMovedUntilItIsTold) {
  const GaitdTaskReferences out = run(0.5);
  EXPECT_EQ(out.com_shift[0], 0.0);
  EXPECT_EQ(out.pelvis_turn[3], 1.0);
  EXPECT_EQ(out.chest_turn[3], 1.0);
  for (int i = 0; i < atlas().joint_count; ++i) {
    EXPECT_EQ(out.joint_position[i], atlas().nominal_position[i]) << i;
  }
  EXPECT_EQ(out.hands[GAITD_LEFT].active, 0);
}

TEST_F(TrajectoryPlayerTest, ThePelvisGoesThereWithoutAJerkAndStays) {
  GaitdMotion& motion = ask(GAITD_PART_PELVIS, GAITD_MOTION_PELVIS, 0b111111, 1.5);
  motion.points[0].value[1] = 0.06;
  motion.points[0].value[2] = -0.08;
  motion.points[0].value[5] = 0.2;
  double before = 0.0;
  for (int i = 0; i < 1500; ++i) {
    const GaitdTaskReferences now = tick(player_);
    EXPECT_LT(std::abs(now.com_shift[1] - before), 3e-4) << i;
    before = now.com_shift[1];
  }
  const GaitdTaskReferences out = run(1.0);
  EXPECT_NEAR(out.com_shift[1], 0.06, 1e-12);
  EXPECT_EQ(out.com_shift_velocity[1], 0.0);
  EXPECT_NEAR(out.com_shift[2], -0.08, 1e-12);
  EXPECT_NEAR(sdk::yaw_of(sdk::quaternion(out.pelvis_turn)), 0.2, 1e-9);
}

TEST_F(TrajectoryPlayerTest, AWalkTakesTheShiftBackAndKeepsTheTurn) {
  GaitdMotion& motion = ask(GAITD_PART_PELVIS, GAITD_MOTION_PELVIS, 0b111111, 1.0);
  motion.points[0].value[0] = 0.05;
  motion.points[0].value[4] = 0.1;
  run(1.5);
  ASSERT_FALSE(walk_.machine.walk({.steps = 2, .length = 0.1}).refused());
  walk_.tick();
  ASSERT_NE(walk_.gait().phase, GAITD_PHASE_STAND);
  const GaitdTaskReferences out = run(1.0);
  EXPECT_NEAR(out.com_shift[0], 0.0, 1e-12);
  EXPECT_NEAR(sdk::roll_pitch_yaw(sdk::quaternion(out.pelvis_turn)).y(), 0.1, 1e-9);
}

TEST_F(TrajectoryPlayerTest, AWalkLeavesTheRestOfTheMotionItsTime) {
  GaitdMotion& motion = ask(GAITD_PART_PELVIS, GAITD_MOTION_PELVIS, 0b111111, 6.0);
  motion.points[0].value[0] = 0.05;
  motion.points[0].value[5] = 0.2;
  run(2.0);
  ASSERT_FALSE(walk_.machine.walk({.steps = 2, .length = 0.1}).refused());
  walk_.tick();
  const auto yaw = [](const GaitdTaskReferences& out) {
    return sdk::yaw_of(sdk::quaternion(out.pelvis_turn));
  };
  GaitdTaskReferences out = run(1.0);
  EXPECT_NEAR(out.com_shift[0], 0.0, 1e-12);
  EXPECT_NEAR(yaw(out), 0.1, 1e-3);
  GaitdTaskSourceState state{};
  player_.get_state(state);
  out = run(3.1);
  EXPECT_NEAR(out.com_shift[0], 0.0, 1e-12);
  EXPECT_NEAR(yaw(out), 0.2, 1e-9);
  // Another instance goes on with it, too.
  player_.set_state(state);
  out = run(3.1);
  EXPECT_NEAR(yaw(out), 0.2, 1e-9);
}

TEST_F(TrajectoryPlayerTest, JointsGoWhereTheyAreToldTheOthersStay) {
  const sdk::Chain arm = sdk::arm_of(atlas(), GAITD_LEFT);
  ask(GAITD_PART_LEFT_ARM, GAITD_MOTION_ARM, 0b1000, 1.0).points[0].value[3] = 1.2;
  const GaitdTaskReferences out = run(1.2);
  for (int i = 0; i < arm.count; ++i) {
    const int joint = arm.joints[i];
    EXPECT_NEAR(out.joint_position[joint], i == 3 ? 1.2 : atlas().nominal_position[joint], 1e-12);
  }
}

TEST_F(TrajectoryPlayerTest, AHandFollowsItsWayAndItsRatesFit) {
  const JointChain arm = JointChain::arm(atlas(), GAITD_LEFT);
  const JointChain::Pose start = arm.pose(arm.nominal());
  GaitdMotion& motion = ask(GAITD_PART_LEFT_ARM, GAITD_MOTION_HAND, 0b000111, 1.0);
  motion.frame = GAITD_RELATIVE_TO_CHEST;
  const Eigen::Vector3d goal = start.position + Eigen::Vector3d(0.15, 0.05, 0.2);
  sdk::view(motion.points[0].value).head<3>() = goal;
  GaitdTaskReferences last = tick(player_);
  for (int i = 0; i < 1200; ++i) {
    const GaitdTaskReferences now = tick(player_);
    EXPECT_LT(now.hands[GAITD_LEFT].reach_error[0], 1e-3) << i;
    const JointChain::Joints rates = arm.of(now.joint_velocity);
    for (int k = 0; k < arm.size(); ++k) {
      const int joint = arm.joint(k);
      const double rate = (now.joint_position[joint] - last.joint_position[joint]) / walk_.dt;
      EXPECT_NEAR(now.joint_velocity[joint], rate, 1e-6);
      const double change = (now.joint_velocity[joint] - last.joint_velocity[joint]) / walk_.dt;
      // What the pull to the nominal posture, 1/s, changes of the rates is not fed forward.
      EXPECT_NEAR(now.joint_acceleration[joint], change, 0.5 + rates.norm()) << i;
    }
    last = now;
  }
  const JointChain::Pose end = arm.pose(arm.of(last.joint_position));
  EXPECT_LT((end.position - goal).norm(), 1e-4);
  EXPECT_LT(JointChain::miss(start, end).turn, 1e-3) << "the orientation was to stay";
  EXPECT_EQ(last.hands[GAITD_LEFT].on_its_way, 1);
  EXPECT_EQ(run(0.2).hands[GAITD_LEFT].on_its_way, 0);
}

TEST_F(TrajectoryPlayerTest, AHandInTheWorldStaysThereWhenTheRobotMoves) {
  GaitdMotion& motion = ask(GAITD_PART_RIGHT_ARM, GAITD_MOTION_HAND, 0b111000, 0.5);
  motion.frame = GAITD_RELATIVE_TO_WORLD;
  const JointChain arm = JointChain::arm(atlas(), GAITD_RIGHT);
  sdk::view(motion.points[0].value).segment<3>(3) =
      sdk::roll_pitch_yaw(arm.pose(arm.nominal()).orientation);
  run(0.6);
  const Eigen::Vector3d before = sdk::view(tick(player_).hands[GAITD_RIGHT].goal.position);
  for (int i = 0; i < 100; ++i) {
    walk_.robot.pelvis_position[0] -= 5e-4;
    tick(player_);
  }
  const GaitdTaskReferences out = run(0.2);
  EXPECT_LT((sdk::view(out.hands[GAITD_RIGHT].goal.position) - before).norm(), 1e-9);
  EXPECT_LT(out.hands[GAITD_RIGHT].reach_error[0], 1e-3);
}

TEST_F(TrajectoryPlayerTest, OutOfReachItSaysByHowMuch) {
  GaitdMotion& motion = ask(GAITD_PART_LEFT_ARM, GAITD_MOTION_HAND, 0b000111, 2.0);
  motion.frame = GAITD_RELATIVE_TO_CHEST;
  motion.points[0].value[0] = 2.0;
  motion.points[0].value[1] = 0.3;
  motion.points[0].value[2] = 0.4;
  const GaitdTaskReferences out = run(4.0);
  EXPECT_GT(out.hands[GAITD_LEFT].reach_error[0], 0.5);
  const sdk::Chain arm = sdk::arm_of(atlas(), GAITD_LEFT);
  for (int i = 0; i < arm.count; ++i) {
    const GaitdJoint& joint = atlas().joints[arm.joints[i]];
    EXPECT_GE(out.joint_position[arm.joints[i]], joint.position_min - 1e-9);
    EXPECT_LE(out.joint_position[arm.joints[i]], joint.position_max + 1e-9);
    EXPECT_LT(std::abs(out.joint_velocity[arm.joints[i]]), 0.5) << "it comes to rest";
  }
}

TEST_F(TrajectoryPlayerTest, AnotherInstanceGoesOnFromItsState) {
  GaitdMotion& pelvis = ask(GAITD_PART_PELVIS, GAITD_MOTION_PELVIS, 0b111111, 1.0);
  pelvis.points[0].value[1] = 0.05;
  pelvis.points[0].value[3] = 0.1;
  ask(GAITD_PART_LEFT_ARM, GAITD_MOTION_ARM, 0b1000, 1.0).points[0].value[3] = 1.2;
  GaitdMotion& hand = ask(GAITD_PART_RIGHT_ARM, GAITD_MOTION_HAND, 0b000111, 1.0);
  hand.frame = GAITD_RELATIVE_TO_PELVIS;
  hand.points[0].value[0] = 0.4;
  hand.points[0].value[1] = -0.3;
  run(0.4);
  GaitdTaskSourceState state{};
  state.size = sizeof(state);
  player_.get_state(state);
  TrajectoryPlayer other(atlas());
  other.set_state(state);
  GaitdTaskSourceState again{};
  again.size = sizeof(again);
  other.get_state(again);
  EXPECT_EQ(std::memcmp(&state, &again, sizeof(state)), 0);
  for (int i = 0; i < 800; ++i) {
    const GaitdTaskReferences a = tick(player_), b = tick(other);
    EXPECT_NEAR(a.com_shift[1], b.com_shift[1], 1e-9) << i;
    for (int k = 0; k < atlas().joint_count; ++k) {
      EXPECT_NEAR(a.joint_position[k], b.joint_position[k], 1e-6) << i << " " << k;
    }
  }
}

}  // namespace
}  // namespace gaitd::plugins
