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

TEST(GaitRecovery, FootstepsThatWaitAreDropped) {
  SyntheticWalk w;
  ASSERT_FALSE(w.machine.walk({.steps = 6, .length = 0.3}).refused());
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_SWING, 2));
  ASSERT_FALSE(w.machine.pause().refused());
  ASSERT_TRUE(w.run_until_stand());
  ASSERT_EQ(w.gait().paused, 1);
  w.icp_error = 0.6;
  ASSERT_TRUE(w.run_until([&] { return w.gait().phase == GAITD_PHASE_SWING; }, 0.2));
  EXPECT_EQ(w.gait().footstep_count, 1);
  EXPECT_EQ(w.gait().paused, 0);
}

}  // namespace
}  // namespace gaitd::walking
