// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/leg_geometry.h"

#include <gtest/gtest.h>

#include <cmath>

#include "gaitd/dynamics/kinematics.h"
#include "gaitd/sdk/views.h"
#include "walking/test/atlas.h"

namespace gaitd::walking {
namespace {

using testing::atlas;

TEST(LegGeometry, LengthsAreThoseOfTheRobot) {
  dynamics::Kinematics kinematics(atlas());
  for (int side : {GAITD_LEFT, GAITD_RIGHT}) {
    const GaitdLeg& leg = atlas().legs[side];
    const LegGeometry geometry(atlas(), side);
    for (double knee : {0.0, 0.2, 0.9, 1.8}) {
      Eigen::VectorXd q = Eigen::VectorXd::Zero(atlas().joint_count);
      q[leg.knee] = leg.knee_bend_sign * knee;
      kinematics.update(Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity(),
                        sdk::Vector6d::Zero(), q, Eigen::VectorXd::Zero(atlas().joint_count));
      const Eigen::Vector3d hip = kinematics.p_WB(atlas().joints[leg.hip_pitch].child_body);
      const Eigen::Vector3d ankle = kinematics.p_WB(atlas().joints[leg.ankle_pitch].child_body);
      EXPECT_NEAR(geometry.length(knee), (hip - ankle).norm(), 1e-3) << knee;
      if (knee > 0.3) EXPECT_NEAR(geometry.knee(geometry.length(knee)), knee, 1e-9);
    }
  }
}

TEST(LegGeometry, LengthsOutOfReachGiveTheNearestKnee) {
  const LegGeometry geometry(atlas(), GAITD_LEFT);
  EXPECT_TRUE(std::isfinite(geometry.knee(10.0)));
  EXPECT_LT(geometry.knee(10.0), 0.3);
  EXPECT_GT(geometry.knee(0.0), 2.5);
}

TEST(StepReach, ShortLevelStepsLeaveTheLegStraight) {
  const LegGeometry leg(atlas(), GAITD_LEFT);
  const StepReach r = step_reach(leg, 0.35, 0.0, 0.175, 0.2, 0.13);
  EXPECT_NEAR(r.straight_knee, 0.2, 1e-6);
  EXPECT_NEAR(r.collapsed_knee, 0.2, 0.02);
}

TEST(StepReach, LongStepsBendTheKneeAndDropsCollapseIt) {
  const LegGeometry leg(atlas(), GAITD_LEFT);
  EXPECT_GT(step_reach(leg, 1.0, 0.0, 0.5, 0.2, 0.1).straight_knee, 0.4);
  double last = 0.0;
  for (double drop : {0.05, 0.1, 0.15, 0.2}) {
    const StepReach r = step_reach(leg, 0.3, drop, 0.15, 0.2, 0.13);
    EXPECT_NEAR(r.straight_knee, 0.2, 1e-6);
    EXPECT_GT(r.collapsed_knee, last + 0.1);
    last = r.collapsed_knee;
  }
  EXPECT_LT(last, 2.0);
  EXPECT_TRUE(std::isfinite(step_reach(leg, 5.0, 3.0, 2.5, 0.2, 0.13).collapsed_knee));
}

TEST(StepReach, AHipThatComesLateHasToComeLower) {
  const LegGeometry leg(atlas(), GAITD_LEFT);
  const StepReach half_way = step_reach(leg, 0.7, 0.0, 0.35, 0.2, 0.2);
  const StepReach late = step_reach(leg, 0.7, 0.0, 0.2, 0.2, 0.2);
  EXPECT_NEAR(half_way.collapsed_knee, 0.2, 1e-6);
  // The knee with which the leg that stands is as high as the other needs it.
  const double longest = leg.length(0.2);
  const double height = std::sqrt(longest * longest - 0.5 * 0.5);
  EXPECT_NEAR(leg.length(late.collapsed_knee), std::hypot(height, 0.2), 1e-6);
  EXPECT_GT(late.collapsed_knee, 0.6);
}

}  // namespace
}  // namespace gaitd::walking
