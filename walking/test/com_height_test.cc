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

// The left foot has landed 0.3 m ahead of the right one, on ground `below` it (m).
GaitdGaitState landed(double below, bool final) {
  GaitdGaitState gait{};
  gait.phase = GAITD_PHASE_TRANSFER;
  gait.phase_duration = 1.0;
  gait.transfer_final = final ? 1 : 0;
  gait.trailing_side = GAITD_RIGHT;
  gait.next_side = final ? GAITD_BOTH : GAITD_RIGHT;
  gait.footholds[GAITD_RIGHT].pose = at(0.0, -0.125, 0.0);
  gait.footholds[GAITD_LEFT].pose = at(0.3, 0.125, -below);
  gait.adjusted[0].side = GAITD_RIGHT;
  gait.adjusted[0].pose = at(0.6, -0.125, -below);
  gait.footstep_count = final ? 0 : 1;
  return gait;
}

TEST(ComHeight, BeginsATransferDownAsLowAsALegReaches) {
  for (bool final : {false, true}) {
    const double height = com_height_target(landed(0.2, final), kReach);
    // Of the leg that has landed, with the hip 0.6 of the step behind the foothold.
    const double hip = height - (kReach.standing_height - kReach.leg_length);
    EXPECT_NEAR(std::hypot(hip + 0.2, 0.6 * 0.3), kReach.longest, 1e-9) << final;
  }
}

TEST(ComHeight, IsAsHighAsOnLevelGroundForFootholdsInReach) {
  for (double below : {-0.2, -0.1, 0.0, 0.05}) {
    EXPECT_NEAR(com_height_target(landed(below, false), kReach), kReach.standing_height, 1e-9)
        << below;
  }
}

TEST(ComHeight, StaysLowEnoughForATrailingLegOnLowerGround) {
  GaitdGaitState gait = landed(-0.2, false);
  for (double share : {0.0, 0.5, 0.9, 1.0}) {
    gait.time_in_phase = share;
    const double height = com_height_target(gait, kReach);
    const double hip = height - (kReach.standing_height - kReach.leg_length);
    EXPECT_LE(std::hypot(hip, 0.9 * 0.3), kReach.longest + 1e-9) << share;
  }
}

TEST(ComHeight, ComesUpOverAHigherFootInTheFirstHalfOfTheSwing) {
  GaitdGaitState gait = landed(-0.2, false);
  gait.time_in_phase = 1.0;
  const double lift_off = com_height_target(gait, kReach);
  gait.phase = GAITD_PHASE_SWING;
  gait.support = GAITD_LEFT;
  gait.time_in_phase = 0.0;
  EXPECT_NEAR(com_height_target(gait, kReach), lift_off, 1e-9);
  gait.time_in_phase = 0.5;
  EXPECT_NEAR(com_height_target(gait, kReach), 0.2 + kReach.standing_height, 1e-9);
}

}  // namespace
}  // namespace gaitd::walking
