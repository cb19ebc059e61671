// SPDX-License-Identifier: Apache-2.0
// The way back to the commanded footholds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "walking/test/synthetic_walk.h"

namespace gaitd::walking {
namespace {

using testing::atlas;
using testing::SyntheticWalk;

// Moves the foothold of one swing, as a step adjuster does with a robot that is pushed.
class PushedWalk : public SyntheticWalk {
 public:
  PushedWalk(int step, double forward, double left) : step_(step) {
    on_update = [this, forward, left] {
      const GaitdGaitState& g = gait();
      const bool now = g.phase == GAITD_PHASE_SWING && g.step_index == step_;
      adjustment.active = now ? 1 : 0;
      adjustment.shift[0] = now ? forward : 0.0;
      adjustment.shift[1] = now ? left : 0.0;
      check_feet();
    };
  }
  // m, sideways, of the middles of the soles of a step that comes back, at least.
  double closest = 1.0;
  int swings = 0;
  std::vector<int> ahead = {};  // by step: the footsteps that the plan knew in its swing

 private:
  void check_feet() {
    const GaitdGaitState& g = gait();
    swings = std::max(swings, static_cast<int>(g.step_index));
    if (g.phase != GAITD_PHASE_SWING || g.step_index <= step_) return;
    ahead.resize(g.step_index + 1, 0);
    ahead[g.step_index] = g.footstep_count;
    const double apart = g.adjusted[0].pose.position[1] - g.footholds[g.support].pose.position[1];
    closest = std::min(closest, side_sign(g.next_side) * apart);
  }
  int step_;
};

double middle_of_feet(const GaitdGaitState& gait, int axis) {
  return 0.5 * (gait.footholds[GAITD_LEFT].pose.position[axis] +
                gait.footholds[GAITD_RIGHT].pose.position[axis]);
}

TEST(GaitReturn, EndsWhereItWasToldAfterAPushInTheLastSteps) {
  for (const auto& [forward, left] : {std::pair{0.0, 0.4}, {-0.4, 0.0}, {0.3, -0.3}}) {
    PushedWalk w(4, forward, left);
    w.run_for(0.1);
    const double start = middle_of_feet(w.gait(), 0);
    ASSERT_FALSE(w.machine.walk({.steps = 4, .length = 0.3, .first_side = GAITD_RIGHT}).refused());
    w.run_for(0.5);
    ASSERT_TRUE(w.run_until_stand());
    EXPECT_NEAR(middle_of_feet(w.gait(), 0), start + 4 * 0.3, 0.05) << forward << ' ' << left;
    EXPECT_NEAR(middle_of_feet(w.gait(), 1), 0.0, 0.05) << forward << ' ' << left;
    EXPECT_GT(w.swings, 5);
    EXPECT_LT(w.swings, 16);
    // Soles are 0.13 m wide.
    EXPECT_GT(w.closest, 0.13) << forward << ' ' << left;
    w.run_for(2.0);
    EXPECT_EQ(w.gait().phase, GAITD_PHASE_STAND);
  }
}

// A step that is planned as the last one leaves the ICP between the feet.
TEST(GaitReturn, PlansEveryStepButTheLastWithTheOneThatFollows) {
  PushedWalk w(4, 0.0, 0.4);
  w.run_for(0.1);
  ASSERT_FALSE(w.machine.walk({.steps = 4, .length = 0.3, .first_side = GAITD_RIGHT}).refused());
  w.run_for(0.5);
  ASSERT_TRUE(w.run_until_stand());
  constexpr int kFirst = 6;  // four steps, and one that closes
  ASSERT_GT(w.swings, kFirst + 1);
  for (int step = kFirst; step < w.swings; ++step) EXPECT_GE(w.ahead[step], 2) << step;
  EXPECT_EQ(w.ahead[w.swings], 1);
}

TEST(GaitReturn, AWalkThatWasNotMovedTakesTheStepsItWasTold) {
  PushedWalk w(99, 0.0, 0.0);
  w.run_for(0.1);
  ASSERT_FALSE(w.machine.walk({.steps = 4, .length = 0.3, .first_side = GAITD_RIGHT}).refused());
  w.run_for(0.5);
  ASSERT_TRUE(w.run_until_stand());
  EXPECT_EQ(w.swings, 5);  // and the closing one
}

TEST(GaitReturn, WhoIsStoppedStaysWhereHeIs) {
  PushedWalk w(3, 0.0, 0.4);
  w.run_for(0.1);
  ASSERT_FALSE(w.machine.walk({.steps = 8, .length = 0.3, .first_side = GAITD_RIGHT}).refused());
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_TRANSFER, 4));
  ASSERT_FALSE(w.machine.stop().refused());
  ASSERT_TRUE(w.run_until_stand());
  const int swings = w.swings;
  w.run_for(2.0);
  EXPECT_EQ(w.gait().phase, GAITD_PHASE_STAND);
  EXPECT_EQ(w.swings, swings);
  EXPECT_LT(w.swings, 6);
}

TEST(GaitReturn, ADriveLeadsNowhere) {
  const auto swings_of_a_drive = [](int pushed) {
    PushedWalk w(pushed, 0.0, 0.15);
    w.run_for(0.1);
    EXPECT_FALSE(w.machine.walk({.steps = 8, .length = 0.3, .first_side = GAITD_RIGHT}).refused());
    EXPECT_TRUE(w.run_until_phase(GAITD_PHASE_SWING, 2));
    EXPECT_FALSE(w.machine.drive({.velocity = {0.2, 0, 0}}).refused());  // which nobody renews
    EXPECT_TRUE(w.run_until_stand());
    return w.swings;
  };
  // Pushed in its last step, it takes the one that closes the feet at most.
  const int last = swings_of_a_drive(99);
  EXPECT_LE(swings_of_a_drive(last), last + 1);
}

TEST(GaitReturn, ANewWalkGoesOnFromTheOldWay) {
  PushedWalk w(4, 0.0, 0.4);
  w.run_for(0.1);
  const double start = middle_of_feet(w.gait(), 0);
  ASSERT_FALSE(w.machine.walk({.steps = 4, .length = 0.3, .first_side = GAITD_RIGHT}).refused());
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_SWING, 5));
  const Refusal refused = w.machine.walk({.steps = 4, .length = 0.3});
  ASSERT_FALSE(refused.refused()) << refused.message;
  w.run_for(0.5);
  ASSERT_TRUE(w.run_until_stand());
  EXPECT_NEAR(middle_of_feet(w.gait(), 0), start + 8 * 0.3, 0.05);
  EXPECT_NEAR(middle_of_feet(w.gait(), 1), 0.0, 0.05);
}

}  // namespace
}  // namespace gaitd::walking
