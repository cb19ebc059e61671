// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/swing_limits.h"

#include <gtest/gtest.h>

#include <string>

#include "walking/test/synthetic_walk.h"

namespace gaitd::walking {
namespace {

using testing::atlas;
using testing::footstep;
using testing::SyntheticWalk;

// A left foot that goes `ahead` of a right one, from as far behind it.
Refusal refusal_of_swing(const GaitdModel& model, double ahead, double rise, double duration,
                         double height) {
  GaitdFootstep step = footstep(GAITD_LEFT, ahead, 0.2264, rise);
  step.swing_duration = duration;
  step.swing_height = height;
  const GaitdPose from = footstep(GAITD_LEFT, -ahead, 0.2264, -rise).pose;
  return SwingLimits(model).check(step, footstep(GAITD_RIGHT, 0, 0).pose, from, 2);
}

TEST(SwingLimits, WhatLegsCanDoIsAccepted) {
  EXPECT_STREQ(refusal_of_swing(atlas(), 0.35, 0.0, 0.6, 0.13).message, "");
  EXPECT_STREQ(refusal_of_swing(atlas(), 0.7, 0.0, 0.7, 0.13).message, "");
  EXPECT_STREQ(refusal_of_swing(atlas(), -0.25, 0.0, 0.6, 0.13).message, "");
  EXPECT_STREQ(refusal_of_swing(atlas(), 0.39, 0.2, 0.9, 0.13).message, "") << "stairs";
  EXPECT_STREQ(refusal_of_swing(atlas(), 0.3, -0.2, 0.7, 0.13).message, "");
}

TEST(SwingLimits, AFootThatIsTooFastIsRefusedWithTheDurationThatItNeeds) {
  const std::string message = refusal_of_swing(atlas(), 0.35, 0.0, 0.1, 0.13).message;
  EXPECT_NE(message.find("footstep 2 (left): 0.700 m in a swing of 0.10 s"), std::string::npos)
      << message;
  EXPECT_NE(message.find("of l_leg_kny, at most 12.0 expected"), std::string::npos) << message;
  const auto advice = message.rfind("take ");
  ASSERT_NE(advice, std::string::npos) << message;
  const double enough = std::stod(message.substr(advice + 5)) + 0.01;
  EXPECT_STREQ(refusal_of_swing(atlas(), 0.35, 0.0, enough, 0.13).message, "");
  EXPECT_TRUE(refusal_of_swing(atlas(), 0.35, 0.0, enough - 0.03, 0.13).refused());
}

TEST(SwingLimits, FollowTheVelocityLimitsOfTheModel) {
  ASSERT_FALSE(refusal_of_swing(atlas(), 0.35, 0.0, 0.6, 0.13).refused());
  GaitdModel slow = atlas();
  slow.joints[slow.legs[GAITD_LEFT].knee].velocity_limit = 2.0;
  EXPECT_NE(std::string(refusal_of_swing(slow, 0.35, 0.0, 0.6, 0.13).message).find("l_leg_kny"),
            std::string::npos);
  slow = atlas();
  slow.joints[slow.legs[GAITD_LEFT].hip_pitch].velocity_limit = 0.5;
  EXPECT_NE(std::string(refusal_of_swing(slow, 0.35, 0.0, 0.6, 0.13).message).find("l_leg_hpy"),
            std::string::npos);
}

TEST(SwingLimits, AFootIsNotLiftedHigherThanTheKneeBends) {
  const std::string message = refusal_of_swing(atlas(), 0.2, 0.0, 2.0, 0.8).message;
  EXPECT_NE(message.find("the foot would rise to 0.800 m"), std::string::npos) << message;
  EXPECT_STREQ(refusal_of_swing(atlas(), 0.2, 0.0, 2.0, 0.3).message, "");
}

TEST(SwingLimits, HoldForWalksAndFootstepsAlsoBehindThoseAhead) {
  SyntheticWalk w;
  EXPECT_TRUE(w.machine.walk({.steps = 3, .length = 0.5, .swing_duration = 0.1}).refused());
  ASSERT_FALSE(w.machine.walk({.steps = 3, .length = 0.5, .first_side = GAITD_LEFT}).refused());
  EXPECT_TRUE(w.machine.walk({.steps = 3, .length = 0.5, .swing_duration = 0.1}).refused());
  // The last footstep ahead is the closing right one at 1.5 m.
  GaitdFootstep step = footstep(GAITD_LEFT, 1.6, 0.12);
  step.swing_duration = 0.1;
  EXPECT_TRUE(w.machine.footsteps(&step, 1, false).refused());
  step.swing_duration = 0.0;
  EXPECT_FALSE(w.machine.footsteps(&step, 1, false).refused());
}

}  // namespace
}  // namespace gaitd::walking
