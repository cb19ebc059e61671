// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/turn_reach.h"

#include <gtest/gtest.h>

#include <string>

#include "walking/test/allocation_counter.h"
#include "walking/test/synthetic_walk.h"

namespace gaitd::walking {
namespace {

using testing::atlas;
using testing::footstep;
using testing::SyntheticWalk;

// The first joint of a leg of Atlas is its yaw: its limits are those of a flat foot.
TEST(TurnReach, OfALegThatBeginsWithItsYawIsTheRangeOfThatJoint) {
  const TurnReach reach(atlas());
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const GaitdJoint& yaw = atlas().joints[atlas().legs[side].joints[0]];
    EXPECT_NEAR(reach.right_end(side).yaw, yaw.position_min, 1e-3);
    EXPECT_NEAR(reach.left_end(side).yaw, yaw.position_max, 1e-3);
    EXPECT_EQ(reach.right_end(side).joint, yaw.name);
    EXPECT_EQ(reach.left_end(side).joint, yaw.name);
  }
}

// With a yaw that is held fast a sole stays as it is; with one that is free other joints end it.
TEST(TurnReach, ComesFromTheLegAsAWhole) {
  GaitdModel model = atlas();
  GaitdJoint& yaw = model.joints[model.legs[GAITD_LEFT].joints[0]];
  yaw.position_min = yaw.position_max = 0.0;
  EXPECT_LT(TurnReach(model).left_end(GAITD_LEFT).yaw, 0.02);
  yaw.position_min = -10.0;
  yaw.position_max = 10.0;
  EXPECT_GT(TurnReach(model).left_end(GAITD_LEFT).yaw, 1.0);
}

TEST(TurnReach, FeetTurnFurtherAwayFromEachOtherThanTowardsEachOther) {
  for (const int side : {GAITD_LEFT, GAITD_RIGHT}) {
    const double outwards = side_sign(side);
    for (const double turn : {0.75, -0.3, -0.5}) {
      SyntheticWalk w;
      const GaitdFootstep step = footstep(side, 0.2, outwards * 0.16, 0.0, outwards * turn);
      EXPECT_STREQ(w.machine.footsteps(&step, 1, false).message, "") << turn;
    }
    SyntheticWalk w;
    const GaitdFootstep step = footstep(side, 0.2, outwards * 0.16, 0.0, outwards * -0.75);
    const std::string message = w.machine.footsteps(&step, 1, false).message;
    EXPECT_NE(message.find("0.750 rad from the other foot, towards it"), std::string::npos)
        << message;
    EXPECT_NE(message.find("by 0.34"), std::string::npos) << message;
    EXPECT_NE(message.find("l_leg_hpz"), std::string::npos) << message;
    EXPECT_NE(message.find("r_leg_hpz"), std::string::npos) << message;
    EXPECT_NE(message.find("take more steps"), std::string::npos) << message;
    EXPECT_EQ(w.gait().footstep_count, 0);
  }
}

// What counts is the turn from the foot beside it, whichever way the robot faces.
TEST(TurnReach, IsOfOneFootAgainstTheOther) {
  const TurnReach reach(atlas());
  const GaitdPose stance = footstep(GAITD_RIGHT, 1.0, 2.0, 0.0, 3.0).pose;
  EXPECT_FALSE(reach.check(footstep(GAITD_LEFT, 1.0, 1.8, 0.0, 3.5), stance, 1).refused());
  EXPECT_FALSE(reach.check(footstep(GAITD_LEFT, 1.0, 1.8, 0.0, 2.6), stance, 1).refused());
  EXPECT_TRUE(reach.check(footstep(GAITD_LEFT, 1.0, 1.8, 0.0, 2.4), stance, 1).refused());
}

TEST(TurnReach, TurnsThatAreWalkedAreAccepted) {
  for (const double turn : {0.2, -0.4, 0.5}) {
    SyntheticWalk w;
    EXPECT_STREQ(w.machine.walk({.steps = 6, .turn = turn}).message, "") << turn;
  }
  SyntheticWalk w;
  EXPECT_TRUE(w.machine.walk({.steps = 6, .turn = 0.7}).refused());
}

TEST(TurnReach, ACheckNeverAllocates) {
  const TurnReach reach(atlas());
  const GaitdFootstep step = footstep(GAITD_LEFT, 0.2, 0.2264, 0.0, -0.75);
  const GaitdPose stance = footstep(GAITD_RIGHT, 0.0, 0.0).pose;
  const int before = testing::allocation_count();
  EXPECT_TRUE(reach.check(step, stance, 1).refused());
  EXPECT_EQ(testing::allocation_count(), before);
}

}  // namespace
}  // namespace gaitd::walking
