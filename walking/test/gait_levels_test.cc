// SPDX-License-Identifier: Apache-2.0
// Footsteps that the gait makes itself on ground that is not one level.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "gaitd/sdk/views.h"
#include "walking/test/synthetic_walk.h"

namespace gaitd {
namespace {

using testing::atlas;
using testing::SyntheticWalk;

constexpr double kRiser = 0.15;  // m

// Footsteps in place of those where the feet stand, `ahead` (m) of them.
GaitdFootstep ahead_of(const GaitdGaitState& gait, int side, double ahead) {
  GaitdFootstep step{};
  step.side = side;
  step.pose = gait.footholds[side].pose;
  step.pose.position[0] += ahead;
  step.swing_duration = step.transfer_duration = 1.0;
  step.swing_height = 0.25;
  return step;
}

// With the left foot on a step of `kRiser`, the right one below.
void climb_half(SyntheticWalk& w) {
  ASSERT_FALSE(w.machine.set_mode(GAITD_MODE_WALK_BENT).refused());
  GaitdFootstep up = ahead_of(w.gait(), GAITD_LEFT, 0.25);
  up.pose.position[2] += kRiser;
  ASSERT_FALSE(w.machine.footsteps(&up, 1, false).refused());
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_SWING, 1));
  ASSERT_TRUE(w.run_until_stand());
}

TEST(GaitLevels, AWalkGoesOnAtTheLevelOfTheFootItBeginsOn) {
  for (const int first : {GAITD_LEFT, GAITD_RIGHT}) {
    SyntheticWalk w;
    climb_half(w);
    const double level = first == GAITD_RIGHT ? kRiser : 0.0;
    ASSERT_FALSE(w.machine.walk({.steps = 2, .length = 0.2, .first_side = first}).refused());
    w.tick();
    ASSERT_EQ(w.gait().footstep_count, 3);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(w.gait().commanded[i].pose.position[2], level, 1e-9) << first << ' ' << i;
    }
  }
}

TEST(GaitLevels, SoDoesAVelocity) {
  SyntheticWalk w;
  climb_half(w);
  ASSERT_FALSE(w.machine.drive({.velocity = {.forward = 0.2}}).refused());
  w.tick();
  ASSERT_GT(w.gait().footstep_count, 1);
  const double level = w.gait().commanded[0].side == GAITD_RIGHT ? kRiser : 0.0;
  for (int i = 0; i < w.gait().footstep_count; ++i) {
    EXPECT_NEAR(w.gait().commanded[i].pose.position[2], level, 1e-9) << i;
  }
}

// On ground that falls to the right by `slope` (rad) below both feet, or one of them.
std::array<GaitdFootstep, 4> steps_across(const GaitdGaitState& gait, double left, double right) {
  std::array<GaitdFootstep, 4> steps;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const int side = i % 2 == 0 ? GAITD_LEFT : GAITD_RIGHT;
    steps[i] = ahead_of(gait, side, 0.15 * static_cast<double>(i + 1));
    const double tilt = side == GAITD_LEFT ? left : right;
    sdk::store(sdk::from_roll_pitch_yaw(tilt, 0.0, 0.0), steps[i].pose.orientation);
    steps[i].pose.position[2] += std::tan(tilt) * steps[i].pose.position[1];
  }
  return steps;
}

TEST(GaitLevels, AStopClosesTheFeetOnTheSlopeOnWhichBothStand) {
  constexpr double kSlope = 0.15;
  for (const double right : {kSlope, -kSlope}) {
    SyntheticWalk w;
    ASSERT_FALSE(w.machine.set_mode(GAITD_MODE_WALK_BENT).refused());
    const auto steps = steps_across(w.gait(), kSlope, right);
    ASSERT_FALSE(w.machine.footsteps(steps.data(), 4, false).refused());
    ASSERT_TRUE(w.run_until_fraction(3, 0.5));  // the left foot swings
    ASSERT_FALSE(w.machine.stop().refused());
    ASSERT_EQ(w.gait().footstep_count, 2);
    const GaitdFootstep& closing = w.gait().commanded[1];
    ASSERT_EQ(closing.closing, 1);
    ASSERT_EQ(closing.side, GAITD_RIGHT);
    // Two soles that lie otherwise say nothing of the ground beside them: level.
    const double tilt = right == kSlope ? kSlope : 0.0;
    EXPECT_NEAR(sdk::roll_pitch_yaw(sdk::quaternion(closing.pose.orientation)).x(), tilt, 1e-9);
    const double fall = steps[2].pose.position[2] - closing.pose.position[2];
    EXPECT_NEAR(fall, std::sin(tilt) * atlas().nominal_foot_separation, 1e-9);
  }
}

TEST(GaitLevels, AWalkFromASlopeAcrossGoesOnAtTheMeanOfItsFeet) {
  SyntheticWalk w;
  ASSERT_FALSE(w.machine.set_mode(GAITD_MODE_WALK_BENT).refused());
  const auto steps = steps_across(w.gait(), 0.15, 0.15);
  ASSERT_FALSE(w.machine.footsteps(steps.data(), 2, false).refused());
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_SWING, 2));
  ASSERT_TRUE(w.run_until_stand());
  const double mean = 0.5 * (steps[0].pose.position[2] + steps[1].pose.position[2]);
  ASSERT_FALSE(w.machine.walk({.steps = 1, .length = 0.1}).refused());
  w.tick();
  EXPECT_NEAR(w.gait().commanded[0].pose.position[2], mean, 1e-9);
}

TEST(GaitLevels, ARefusalCountsTheStepThatTheTransferHasChosen) {
  SyntheticWalk w;
  ASSERT_FALSE(w.machine.set_mode(GAITD_MODE_WALK_BENT).refused());
  ASSERT_FALSE(w.machine.walk({.steps = 4, .length = 0.2, .first_side = GAITD_LEFT}).refused());
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_TRANSFER, 2));
  std::array<GaitdFootstep, 2> again = {w.gait().commanded[0], w.gait().commanded[1]};
  again[1].pose.position[0] += 2.0;
  const walking::Refusal refusal = w.machine.footsteps(again.data(), 2, true);
  ASSERT_TRUE(refusal.refused());
  EXPECT_NE(std::string(refusal.message).find("footstep 2"), std::string::npos) << refusal.message;
}

TEST(GaitLevels, AWalkTakesThePlaceOfARouteAndFollowsOtherFootsteps) {
  for (const bool routed : {true, false}) {
    SyntheticWalk w;
    ASSERT_FALSE(w.machine.set_mode(GAITD_MODE_WALK_BENT).refused());
    std::array<GaitdFootstep, 4> steps = steps_across(w.gait(), 0.0, 0.0);
    ASSERT_FALSE(w.machine.footsteps(steps.data(), 2, true, routed).refused());
    // The rest of what is too long for one command.
    ASSERT_FALSE(w.machine.footsteps(steps.data() + 2, 2, false, routed).refused());
    ASSERT_TRUE(w.run_until_fraction(1, 0.5));
    ASSERT_EQ(w.gait().footstep_count, 4);
    ASSERT_FALSE(w.machine.walk({.steps = 1, .length = 0.1}).refused());
    EXPECT_EQ(w.gait().footstep_count, routed ? 3 : 6);
  }
}

}  // namespace
}  // namespace gaitd
