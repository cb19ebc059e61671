// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/com_height.h"

#include <gtest/gtest.h>

#include <cmath>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/support.h"

namespace gaitd::walking {
namespace {

constexpr LegReach kReach{.standing_height = 1.0,
                          .leg_length = 0.75,
                          .longest = 0.85,
                          .trailing_share = 0.9,
                          .nominal_separation = 0.25,
                          .largest_drop = 0.1};

GaitdPose at(double x, double y, double z) { return {{x, y, z}, {0, 0, 0, 1}}; }

// The left foot steps 0.3 m ahead of the right one, onto ground `below` it (m).
GaitdGaitState step_down(double below) {
  GaitdGaitState gait{};
  gait.phase = GAITD_PHASE_SWING;
  gait.support = GAITD_RIGHT;
  gait.next_side = GAITD_LEFT;
  gait.trailing_side = GAITD_BOTH;
  gait.phase_duration = 1.0;
  gait.footholds[GAITD_RIGHT].pose = at(0.0, -0.125, 0.0);
  gait.footholds[GAITD_LEFT].pose = at(-0.3, 0.125, 0.0);
  gait.footstep_count = 1;
  gait.adjusted[0].side = GAITD_LEFT;
  gait.adjusted[0].pose = at(0.3, 0.125, -below);
  return gait;
}

TEST(ComHeight, ComesDownForALowerFootholdUntilALegReachesIt) {
  GaitdGaitState gait = step_down(0.2);
  gait.time_in_phase = 1.0;
  const double height = com_height_target(gait, kReach);
  // Of the landing leg, with the hip 0.6 of the step behind the foothold.
  const double hip = height - (kReach.standing_height - kReach.leg_length);
  EXPECT_NEAR(std::hypot(hip + 0.2, 0.6 * 0.3), kReach.longest, 1e-9);
  gait.time_in_phase = 0.0;
  EXPECT_GT(com_height_target(gait, kReach), height + 0.1);
}

TEST(ComHeight, IsAsHighAsOnLevelGroundForFootholdsInReach) {
  for (double below : {-0.2, -0.1, 0.0, 0.05}) {
    GaitdGaitState gait = step_down(below);
    gait.time_in_phase = 1.0;
    EXPECT_NEAR(com_height_target(gait, kReach), kReach.standing_height, 1e-9) << below;
  }
}

TEST(ComHeight, GoesOnFromTouchdownWhereItWas) {
  GaitdGaitState gait = step_down(0.2);
  gait.time_in_phase = 1.0;
  const double before = com_height_target(gait, kReach);
  for (bool final : {false, true}) {
    GaitdGaitState landed = gait;
    landed.phase = GAITD_PHASE_TRANSFER;
    landed.transfer_final = final ? 1 : 0;
    landed.trailing_side = GAITD_RIGHT;
    landed.next_side = final ? GAITD_BOTH : GAITD_RIGHT;
    landed.footholds[GAITD_LEFT].pose = gait.adjusted[0].pose;
    landed.adjusted[0].side = GAITD_RIGHT;
    landed.adjusted[0].pose = at(0.6, -0.125, -0.2);
    landed.footstep_count = final ? 0 : 1;
    landed.time_in_phase = 0.0;
    EXPECT_NEAR(com_height_target(landed, kReach), before, 1e-9) << final;
  }
}

}  // namespace
}  // namespace gaitd::walking
