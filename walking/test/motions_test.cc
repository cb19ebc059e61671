// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/motions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "gaitd/sdk/chain.h"
#include "gaitd/sdk/views.h"
#include "walking/test/synthetic_walk.h"

namespace gaitd::walking {
namespace {

using testing::atlas;
using testing::SyntheticWalk;

MotionCommand command_of(int part, int kind, std::uint32_t mask, double time = 1.5) {
  MotionCommand command;
  command.part = part;
  command.motion.kind = kind;
  command.motion.axis_mask = mask;
  command.motion.point_count = 1;
  command.motion.points[0].time = time;
  return command;
}
MotionCommand pelvis_to(int axis, double value) {
  MotionCommand command = command_of(GAITD_PART_PELVIS, GAITD_MOTION_PELVIS, 0b111111);
  command.motion.points[0].value[axis] = value;
  return command;
}

class MotionsTest : public ::testing::Test {
 protected:
  MotionsTest() {
    walk_.machine.set_mode(GAITD_MODE_WALK_BENT);
    walk_.tick();
    std::copy(std::begin(atlas().nominal_position), std::end(atlas().nominal_position),
              references_.joint_position);
    references_.pelvis_turn[3] = references_.chest_turn[3] = 1.0;
  }
  std::string refusal(const MotionCommand& command) {
    return motions_.command(command, walk_.robot, walk_.gait(), references_).message;
  }
  void expect_refused(const MotionCommand& command, const std::string& why) {
    const std::uint32_t before = motions_.state().parts[command.part].id;
    EXPECT_NE(refusal(command).find(why), std::string::npos) << refusal(command);
    EXPECT_EQ(motions_.state().parts[command.part].id, before) << "a refusal changes nothing";
  }

  SyntheticWalk walk_;
  GaitdTaskReferences references_{};
  Motions motions_{atlas()};
};

TEST_F(MotionsTest, EachMotionHasANewId) {
  EXPECT_EQ(motions_.state().parts[GAITD_PART_PELVIS].id, 0u);
  EXPECT_EQ(refusal(pelvis_to(1, 0.05)), "");
  const std::uint32_t first = motions_.state().parts[GAITD_PART_PELVIS].id;
  EXPECT_EQ(refusal(pelvis_to(1, 0.05)), "");
  EXPECT_GT(motions_.state().parts[GAITD_PART_PELVIS].id, first);
  EXPECT_EQ(motions_.state().parts[GAITD_PART_CHEST].id, 0u);
}

TEST_F(MotionsTest, RefusesWhatTheFeetCannotHold) {
  expect_refused(pelvis_to(0, 0.12), "edge of the feet");
  expect_refused(pelvis_to(2, 0.02), "pelvis.z");
  expect_refused(pelvis_to(4, 0.5), "pelvis.pitch");
  expect_refused(pelvis_to(1, std::nan("")), "numbers");
}

// A pelvis that still moves swings out the further, the more time it is given to come to rest.
TEST_F(MotionsTest, RefusesAWayThatSwingsOut) {
  references_.com_shift[1] = 0.05;
  references_.com_shift_velocity[1] = 0.125;
  EXPECT_EQ(refusal(pelvis_to(1, 0.1)), "");
  MotionCommand slow = pelvis_to(1, 0.1);
  slow.motion.points[0].time = 10.0;
  expect_refused(slow, "swing out to");
  references_.com_shift_velocity[1] = 0.0;
  EXPECT_EQ(refusal(slow), "");
  references_.com_shift[1] = 0.0;
  references_.com_shift[2] = -0.05;
  references_.com_shift_velocity[2] = -0.125;
  slow.motion.points[0].value[1] = 0.0;
  expect_refused(slow, "swing out to");
}

TEST_F(MotionsTest, RefusesAFirstWayPointThatIsTooNear) {
  references_.com_shift[1] = -0.14;
  MotionCommand fast = pelvis_to(1, 0.14);
  fast.motion.points[0].time = 0.5;
  expect_refused(fast, "could not stop");
  fast.motion.points[0].time = 3.0;
  EXPECT_EQ(refusal(fast), "");
  MotionCommand turn = pelvis_to(3, 0.15);
  turn.motion.points[0].time = 0.05;
  expect_refused(turn, "turns at");
  MotionCommand chest = command_of(GAITD_PART_CHEST, GAITD_MOTION_CHEST, 0b111000, 0.05);
  chest.motion.points[0].value[5] = 0.3;
  expect_refused(chest, "turns at");
}

TEST_F(MotionsTest, StraightLegsHaveNoHeight) {
  walk_.machine.set_mode(GAITD_MODE_WALK_STRAIGHT);
  walk_.tick();
  expect_refused(pelvis_to(2, -0.05), "straight legs");
  EXPECT_EQ(refusal(pelvis_to(2, 0.0)), "");
}

TEST_F(MotionsTest, AWalkTurnsThePelvisAndShiftsNothing) {
  ASSERT_FALSE(walk_.machine.walk({.steps = 2, .length = 0.1}).refused());
  walk_.tick();
  expect_refused(pelvis_to(1, 0.03), "stands");
  EXPECT_EQ(refusal(pelvis_to(5, 0.1)), "");
}

TEST_F(MotionsTest, RefusesAChestThatTheSpineDoesNotReach) {
  MotionCommand command = command_of(GAITD_PART_CHEST, GAITD_MOTION_CHEST, 0b111000);
  command.motion.points[0].value[5] = 0.3;
  EXPECT_EQ(refusal(command), "");
  command.motion.points[0].value[4] = -0.9;
  expect_refused(command, "the spine misses it by");
}

TEST_F(MotionsTest, RefusesJointsBeyondTheirLimitsOrRates) {
  const int joint = sdk::arm_of(atlas(), GAITD_LEFT).joints[3];
  MotionCommand command = command_of(GAITD_PART_LEFT_ARM, GAITD_MOTION_ARM, 0b1000);
  command.motion.points[0].value[3] = atlas().joints[joint].position_max + 0.1;
  expect_refused(command, atlas().joints[joint].name);
  command.motion.points[0].value[3] = 1.5;
  EXPECT_EQ(refusal(command), "");
  command.motion.points[0].time = 0.1;
  expect_refused(command, "more time");
}

TEST_F(MotionsTest, SaysByHowMuchAHandWillMiss) {
  MotionCommand command = command_of(GAITD_PART_LEFT_ARM, GAITD_MOTION_HAND, 0b000111, 4.0);
  command.motion.frame = GAITD_RELATIVE_TO_CHEST;
  const JointChain arm = JointChain::arm(atlas(), GAITD_LEFT);
  sdk::view(command.motion.points[0].value).head<3>() =
      arm.pose(arm.nominal()).position + Eigen::Vector3d(0.1, 0.0, 0.1);
  EXPECT_EQ(refusal(command), "");
  EXPECT_LT(motions_.last_miss().position, 1e-3);
  command.motion.points[0].value[0] = 2.0;
  EXPECT_EQ(refusal(command), "");
  EXPECT_GT(motions_.last_miss().position, 0.5);
  EXPECT_EQ(refusal(pelvis_to(1, 0.0)), "");
  EXPECT_EQ(motions_.last_miss().position, 0.0);
}

TEST_F(MotionsTest, RefusesAHandOfARobotWithoutHands) {
  GaitdModel bare = atlas();
  bare.hands[GAITD_LEFT].body = 0;
  Motions motions(bare);
  const MotionCommand command = command_of(GAITD_PART_LEFT_ARM, GAITD_MOTION_HAND, 0b000111);
  EXPECT_NE(std::string(motions.command(command, walk_.robot, walk_.gait(), references_).message)
                .find("no left hand"),
            std::string::npos);
}

TEST_F(MotionsTest, RefusesPointsOutOfOrder) {
  MotionCommand command = pelvis_to(1, 0.02);
  command.motion.point_count = 2;
  command.motion.points[1] = command.motion.points[0];
  expect_refused(command, "point 2");
  command.motion.point_count = 0;
  expect_refused(command, "0 points");
}

TEST_F(MotionsTest, TheShiftedPlanIsOneOfTheDivergentComponent) {
  references_.com_shift[1] = 0.02;
  references_.com_shift_velocity[1] = 0.05;
  references_.com_shift_acceleration[1] = -0.3;
  GaitdIcpPlan plan{};
  shift_plan(walk_.gait(), references_, plan);
  const double omega = walk_.gait().omega;
  EXPECT_NEAR(plan.icp[1], 0.02 + 0.05 / omega, 1e-12);
  EXPECT_NEAR(plan.icp_velocity[1], omega * (plan.icp[1] - plan.ecmp[1]), 1e-12);
}

}  // namespace
}  // namespace gaitd::walking
