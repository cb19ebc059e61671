// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "walking/test/synthetic_walk.h"

namespace gaitd::walking {
namespace {

using testing::atlas;
using testing::SyntheticWalk;

constexpr double kLost = 0.3;  // m, of the ICP ahead of the middle of the feet

void set(SyntheticWalk& w, Gait parameter, double value) {
  w.machine.set_parameter(static_cast<int>(parameter), value);
}

TEST(GaitRecovery, AHeldRobotStands) {
  SyntheticWalk w;
  w.icp_error = 0.08;
  w.run_for(1.0);
  EXPECT_EQ(w.gait().phase, GAITD_PHASE_STAND);
  EXPECT_EQ(w.gait().step_index, 0);
}

TEST(GaitRecovery, StepsTowardsTheIcpAndClosesTheFeetAgain) {
  SyntheticWalk w;
  w.run_for(0.1);
  w.icp_error = kLost;
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_SWING, 1, 0.2));
  const GaitdFootstep step = w.gait().commanded[0];
  EXPECT_GT(step.pose.position[0], kLost);
  EXPECT_LE(step.pose.position[0], w.machine.limits().forward + 1e-9);
  const double apart =
      std::abs(step.pose.position[1] - w.gait().footholds[w.gait().support].pose.position[1]);
  EXPECT_GE(apart, atlas().nominal_foot_separation - 1e-9);
  EXPECT_LE(apart, w.machine.limits().largest_separation + 1e-9);
  w.icp_error = 0.0;
  ASSERT_TRUE(w.run_until_stand());
  const GaitdPose& left = w.gait().footholds[GAITD_LEFT].pose;
  const GaitdPose& right = w.gait().footholds[GAITD_RIGHT].pose;
  EXPECT_NEAR(left.position[0], right.position[0], 0.05);
  EXPECT_NEAR(left.position[1] - right.position[1], atlas().nominal_foot_separation, 1e-6);
  w.run_for(1.0);
  EXPECT_EQ(w.gait().phase, GAITD_PHASE_STAND);
}

// Whatever footsteps are accepted: a robot that catches itself does not cross its legs.
TEST(GaitRecovery, StepsNoNarrowerThanItStands) {
  SyntheticWalk w;
  set(w, Gait::kWidestStep, 0.1);
  w.run_for(0.1);
  w.icp_error = kLost;
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_SWING, 1, 0.2));
  const double apart = std::abs(w.gait().commanded[0].pose.position[1] -
                                w.gait().footholds[w.gait().support].pose.position[1]);
  EXPECT_NEAR(apart, atlas().nominal_foot_separation, 1e-9);
}

TEST(GaitRecovery, CanBeTurnedOff) {
  SyntheticWalk w;
  set(w, Gait::kRecovery, 0.0);
  w.run_for(0.1);
  w.icp_error = kLost;
  w.run_for(0.5);
  EXPECT_EQ(w.gait().phase, GAITD_PHASE_STAND);
}

TEST(GaitRecovery, NeitherAMomentNorARobotOnAHoistSteps) {
  SyntheticWalk w;
  w.run_for(0.1);
  w.icp_error = kLost;
  w.run_for(0.003);
  w.icp_error = 0.0;
  w.run_for(0.1);
  EXPECT_EQ(w.gait().phase, GAITD_PHASE_STAND);

  GaitMachine machine(atlas());
  GaitdRobotState robot = w.robot;
  machine.reset(robot);
  robot.icp[0] += kLost;
  for (GaitdFootState& foot : robot.feet) foot.normal_force = 0.0;
  for (int i = 0; i < 100; ++i) machine.update(w.dt, robot, w.plan, w.toe_off, w.adjustment);
  EXPECT_EQ(machine.state().phase, GAITD_PHASE_STAND);
}

// A standing robot that takes a step to catch itself, in the middle of that step.
void push(SyntheticWalk& w) {
  w.run_for(0.1);
  w.icp_error = kLost;
  ASSERT_TRUE(w.run_until([&] { return w.gait().phase == GAITD_PHASE_SWING; }, 0.2));
  w.icp_error = 0.0;
}

TEST(GaitRecovery, BothStepsAreKnownFromTheStart) {
  SyntheticWalk w;
  push(w);
  ASSERT_EQ(w.gait().footstep_count, 2);
  // The second beside the first, wherever that lands.
  w.adjustment.active = 1;
  w.adjustment.shift[0] = 0.1;
  w.adjustment.shift[1] = 0.05;
  w.tick();
  w.tick();
  const double* caught = w.gait().adjusted[0].pose.position;
  const double* closed = w.gait().adjusted[1].pose.position;
  EXPECT_NEAR(closed[0], caught[0], 1e-9);
  EXPECT_NEAR(std::abs(closed[1] - caught[1]), atlas().nominal_foot_separation, 1e-9);
  EXPECT_GE(w.gait().adjusted[1].transfer_duration, 0.2);
}

TEST(GaitRecovery, ClosesWhereTheFootReallyLanded) {
  SyntheticWalk w;
  push(w);
  const int caught = w.gait().next_side;
  w.landing_error = 0.04;
  ASSERT_TRUE(w.run_until([&] { return w.gait().phase == GAITD_PHASE_TRANSFER; }, 1.0));
  EXPECT_NEAR(w.gait().adjusted[0].pose.position[0], w.gait().footholds[caught].pose.position[0],
              1e-9);
}

TEST(GaitRecovery, FootstepsThatWaitAreDroppedAndThePauseLasts) {
  SyntheticWalk w;
  ASSERT_FALSE(w.machine.walk({.steps = 6, .length = 0.3}).refused());
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_SWING, 2));
  ASSERT_FALSE(w.machine.pause().refused());
  ASSERT_TRUE(w.run_until_stand());
  ASSERT_EQ(w.gait().paused, 1);
  w.icp_error = 0.6;
  ASSERT_TRUE(w.run_until([&] { return w.gait().phase == GAITD_PHASE_SWING; }, 0.2));
  EXPECT_EQ(w.gait().footstep_count, 2);
  w.icp_error = 0.0;
  ASSERT_TRUE(w.run_until_stand());
  EXPECT_EQ(w.gait().footstep_count, 0);
  EXPECT_EQ(w.gait().paused, 1);
  const int taken = w.gait().step_index;
  ASSERT_FALSE(w.machine.walk({.steps = 2, .length = 0.3}).refused());
  w.run_for(1.0);
  EXPECT_EQ(w.gait().step_index, taken);
  ASSERT_FALSE(w.machine.resume().refused());
  w.run_for(0.1);
  ASSERT_TRUE(w.run_until_stand());
  EXPECT_EQ(w.gait().step_index, taken + 3);
}

TEST(GaitRecovery, APauseLetsTheRobotCatchItself) {
  SyntheticWalk w;
  push(w);
  ASSERT_FALSE(w.machine.pause().refused());
  ASSERT_TRUE(w.run_until_stand());
  EXPECT_EQ(w.gait().step_index, 2);
}

TEST(GaitRecovery, StopAndAbortLeaveTheStepThatCatchesTheRobot) {
  for (const bool in_transfer : {true, false}) {
    for (const bool abort : {true, false}) {
      SyntheticWalk w;
      w.run_for(0.1);
      w.icp_error = kLost;
      ASSERT_TRUE(w.run_until(
          [&] {
            return w.gait().phase == (in_transfer ? GAITD_PHASE_TRANSFER : GAITD_PHASE_SWING);
          },
          0.2));
      w.icp_error = 0.0;
      const GaitdFootstep caught = w.gait().commanded[0];
      ASSERT_FALSE((abort ? w.machine.abort() : w.machine.stop()).refused());
      EXPECT_EQ(w.gait().commanded[0].id, caught.id);
      ASSERT_TRUE(w.run_until_stand());
      EXPECT_EQ(w.gait().step_index, abort ? 1 : 2);
      EXPECT_NEAR(w.gait().footholds[caught.side].pose.position[0], caught.pose.position[0], 1e-9);
    }
  }
}

TEST(GaitRecovery, FootstepsSentMeanwhileFollowItAndEndWhereTheySay) {
  SyntheticWalk w;
  push(w);
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_SWING, 2, 2.0));
  // One footstep, and no other one to close the feet.
  GaitdFootstep next = w.gait().commanded[0];
  const int side = other_side(next.side);
  next = testing::footstep(side, next.pose.position[0] + 0.2,
                           w.gait().footholds[side].pose.position[1]);
  ASSERT_FALSE(w.machine.footsteps(&next, 1, true).refused());
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_SWING, 3, 3.0));
  EXPECT_EQ(w.gait().footstep_count, 1);
  ASSERT_TRUE(w.run_until_stand());
  EXPECT_EQ(w.gait().step_index, 3);
  EXPECT_NEAR(w.gait().footholds[side].pose.position[0], next.pose.position[0], 1e-9);
}

TEST(GaitRecovery, AWalkOutOfItsFinalTransferTakesItsTime) {
  SyntheticWalk w;
  push(w);
  ASSERT_TRUE(w.run_until([&] { return w.gait().transfer_final != 0; }, 5.0));
  w.run_for(0.1);
  ASSERT_FALSE(w.machine.walk({.steps = 4, .length = 0.2}).refused());
  w.tick();
  w.tick();
  EXPECT_EQ(w.gait().phase, GAITD_PHASE_TRANSFER);
  EXPECT_EQ(w.gait().phase_duration, GaitMachine::kInitialTransfer);
}

}  // namespace
}  // namespace gaitd::walking
