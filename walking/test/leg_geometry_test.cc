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

// Of a robot whose zero is a crouch, a bend counts from the straight leg.
TEST(LegGeometry, BendsCountFromTheStraightLeg) {
  GaitdModel model = atlas();
  const LegGeometry before(model, GAITD_LEFT);
  const GaitdLeg& leg = model.legs[GAITD_LEFT];
  GaitdJoint& knee = model.joints[leg.knee];
  const double crouch = leg.knee_bend_sign * 0.8;
  sdk::store(sdk::quaternion(knee.orientation) *
                 Eigen::Quaterniond(Eigen::AngleAxisd(crouch, sdk::view(knee.axis))),
             knee.orientation);
  knee.position_min -= crouch;
  knee.position_max -= crouch;
  const LegGeometry after(model, GAITD_LEFT);
  for (double at : {0.0, 0.5, 1.5}) {
    const double position = leg.knee_bend_sign * at;
    EXPECT_NEAR(after.length(after.bend(position - crouch)), before.length(before.bend(position)),
                1e-9);
  }
  EXPECT_NEAR(after.length(0.0), 2.0 * 0.4, 0.1);
  EXPECT_NEAR(after.bend(after.straight()), 0.0, 1e-12);
  // Where the knee cannot be straight, from its stop.
  knee.position_min = -0.5;
  EXPECT_NEAR(LegGeometry(model, GAITD_LEFT).straight(), -0.5, 1e-12);
}

// Of a robot whose feet are square to their shanks elsewhere than at zero.
TEST(LegGeometry, AnklesCountFromASquareFoot) {
  GaitdModel model = atlas();
  const GaitdLeg& leg = model.legs[GAITD_LEFT];
  GaitdJoint& ankle = model.joints[leg.ankle_pitch];
  const double sign = leg.ankle_pitch_bend_sign;
  EXPECT_NEAR(LegGeometry(model, GAITD_LEFT).dorsiflexion(sign * 0.3), 0.3, 1e-12);
  const double turned = sign * 0.4;
  sdk::store(sdk::quaternion(ankle.orientation) *
                 Eigen::Quaterniond(Eigen::AngleAxisd(turned, sdk::view(ankle.axis))),
             ankle.orientation);
  EXPECT_NEAR(LegGeometry(model, GAITD_LEFT).dorsiflexion(sign * 0.3 - turned), 0.3, 0.1);
}

TEST(LegGeometry, ABendShortensALegWhereverItsKneeIs) {
  const LegGeometry leg(atlas(), GAITD_LEFT);
  for (double knee : {0.4, 0.9, 1.8}) {
    const double slope = (leg.length(knee - 1e-4) - leg.length(knee + 1e-4)) / 2e-4;
    EXPECT_NEAR(leg.shortening(knee), slope, 1e-6) << knee;
  }
  for (double knee = -0.5; knee < 0.4; knee += 0.01) EXPECT_GT(leg.shortening(knee), 0.01) << knee;
}

TEST(LegGeometry, LengthsOutOfReachGiveTheNearestKnee) {
  const LegGeometry geometry(atlas(), GAITD_LEFT);
  EXPECT_TRUE(std::isfinite(geometry.knee(10.0)));
  EXPECT_LT(geometry.knee(10.0), 0.3);
  EXPECT_GT(geometry.knee(0.0), 2.5);
}

TEST(StraightestKnee, OnlyLongStepsBendIt) {
  const LegGeometry leg(atlas(), GAITD_LEFT);
  EXPECT_NEAR(straightest_knee(leg, 0.35, 0.175, 0.2, 0.13), 0.2, 1e-6);
  EXPECT_GT(straightest_knee(leg, 1.0, 0.5, 0.2, 0.1), 0.4);
  EXPECT_TRUE(std::isfinite(straightest_knee(leg, 5.0, 2.5, 0.2, 0.13)));
}

TEST(StraightestKnee, AHipThatComesLateHasToComeLower) {
  const LegGeometry leg(atlas(), GAITD_LEFT);
  const double late = straightest_knee(leg, 0.9, 0.3, 0.2, 0.1);
  // Just as bent as lets the hip come down to where the landing leg reaches.
  const double longest = leg.length(0.2);
  EXPECT_NEAR(leg.length(late), std::sqrt(longest * longest - 0.6 * 0.6) + 0.1, 1e-6);
  EXPECT_LT(straightest_knee(leg, 0.9, 0.45, 0.2, 0.1), late);
}

}  // namespace
}  // namespace gaitd::walking
