// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/step_timing.h"

#include <gtest/gtest.h>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/support.h"
#include "walking/test/synthetic_walk.h"

namespace gaitd::walking {
namespace {

using testing::atlas;
using testing::SyntheticWalk;

constexpr TimingLimits kTimingLimits = {.knee = 0.2, .drop = 0.25, .roll = 0.9, .change = 0.25};

// At the start of the transfer of step 2, with the CoM a part of the way from the trailing foot to
// the leading one.
struct Start {
  GaitdGaitState gait;
  Eigen::Vector2d com;
};
Start start_of_step(double length, double swing, double transfer, int steps, double part = 0.5) {
  SyntheticWalk walk;
  EXPECT_FALSE(walk.machine
                   .walk({.steps = steps,
                          .length = length,
                          .swing_duration = swing,
                          .transfer_duration = transfer})
                   .refused());
  EXPECT_TRUE(walk.run_until_fraction(2, 0.3));
  Start start{walk.gait(), {}};
  start.gait.phase = GAITD_PHASE_TRANSFER;
  start.gait.trailing_side = start.gait.next_side;
  start.gait.phase_duration = transfer;
  for (auto& foothold : start.gait.footholds) foothold.contact = GAITD_CONTACT_FULL;
  const auto foot = [&](int side) {
    return Eigen::Vector2d(sdk::view(start.gait.footholds[side].pose.position).head<2>());
  };
  const Eigen::Vector2d trailing = foot(start.gait.trailing_side);
  start.com = trailing + part * (foot(other_side(start.gait.trailing_side)) - trailing);
  return start;
}

// One step of 1 m and the one that closes the feet.
Start long_step() { return start_of_step(1.0, 1.0, 0.6, 1, 0.41); }

TEST(StepTiming, LeavesWhatIsWithinReachAlone) {
  StepTiming timing(atlas());
  for (double length : {0.2, 0.35, 0.5}) {
    const Start s = start_of_step(length, 0.6, 0.25, 4);
    EXPECT_LT(timing.excess(s.gait, s.com, kTimingLimits, {}), 0.0) << length;
    for (double change : timing.solve(s.gait, s.com, kTimingLimits)) EXPECT_EQ(change, 0.0);
  }
}

TEST(StepTiming, ShortensALongTransferOfALongStep) {
  StepTiming timing(atlas());
  const Start s = long_step();
  const double before = timing.excess(s.gait, s.com, kTimingLimits, {});
  ASSERT_GT(before, 0.02);
  const auto changes = timing.solve(s.gait, s.com, kTimingLimits);
  EXPECT_LT(changes[0], -0.05);
  EXPECT_LT(timing.excess(s.gait, s.com, kTimingLimits, changes), 0.6 * before);
  const double durations[] = {0.6, 1.0, 0.6, 1.0};
  for (int i = 0; i < StepTiming::kPhases; ++i) {
    EXPECT_LE(std::abs(changes[i]), kTimingLimits.change * durations[i] + 1e-9);
  }
}

TEST(StepTiming, ChangesNoMoreThanIsNeeded) {
  StepTiming timing(atlas());
  const Start s = long_step();
  auto changes = timing.solve(s.gait, s.com, kTimingLimits);
  const double reached = timing.excess(s.gait, s.com, kTimingLimits, changes);
  for (double& change : changes) change *= 0.8;
  EXPECT_GT(timing.excess(s.gait, s.com, kTimingLimits, changes), reached + 1e-3);
}

TEST(StepTiming, SaysTheSameEveryTime) {
  StepTiming timing(atlas());
  const Start s = long_step();
  const auto first = timing.solve(s.gait, s.com, kTimingLimits);
  const Start other = start_of_step(0.85, 0.7, 0.6, 4);
  timing.solve(other.gait, other.com, kTimingLimits);
  EXPECT_EQ(timing.solve(s.gait, s.com, kTimingLimits), first);
}

}  // namespace
}  // namespace gaitd::walking
