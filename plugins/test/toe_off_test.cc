// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "icp_criteria.h"
#include "layer_inputs.h"
#include "never.h"

namespace gaitd::plugins {
namespace {

using testing::atlas;
using testing::SyntheticWalk;

TEST(Never, IsNeverActiveAndNamesTheToePointOfTheTrailingFoot) {
  SyntheticWalk w;
  Never layer(atlas());
  int trailing_seen = 0;
  w.on_update = [&] {
    GaitdToeOff out;
    std::memset(&out, 0x55, sizeof(out));  // whatever stood there before
    const GaitdStepAdjustment adjustment{};
    const GaitdToeOffInput in{
        sizeof(in), 0, testing::layer_time(w.dt), &w.robot, &w.gait(), &w.plan, &adjustment};
    ASSERT_EQ(layer.process(in, out), GAITD_OK);
    ASSERT_EQ(out.active, 0);
    const int side = w.gait().trailing_side;
    if (side == GAITD_BOTH) return;
    ++trailing_seen;
    for (int k = 0; k < 3; ++k) ASSERT_EQ(out.toe_point[k], atlas().feet[side].toe_point[k]);
  };
  ASSERT_FALSE(w.machine.walk({.steps = 3, .length = 0.3}).refused());
  w.tick();
  ASSERT_TRUE(w.run_until_stand());
  EXPECT_GT(trailing_seen, 100);
}

// A walk whose trailing foot has its CoP `cop_ahead` metres ahead of the middle of the sole and
// whose desired CMP is the reference.
class RollingWalk : public SyntheticWalk {
 public:
  explicit RollingWalk(double cop_ahead) : layer(atlas()) {
    on_update = [this, cop_ahead] {
      for (GaitdFootState& foot : robot.feet) {
        foot.contact = GAITD_CONTACT_FULL;
        foot.cop_valid = 1;
        foot.cop[0] = cop_ahead;
        foot.cop[1] = 0.0;
      }
      GaitdStepAdjustment desired{};
      const int lead = walking::other_side(trailing() & 1);
      for (int k = 0; k < 2; ++k) {
        desired.cmp[k] = cmp_at_lead ? gait().footholds[lead].pose.position[k] : 1e3;
      }
      const GaitdToeOffInput in{sizeof(in), 0,       testing::layer_time(dt), &robot, &gait(),
                                &plan,      &desired};
      ASSERT_EQ(layer.process(in, toe_off), GAITD_OK);
      if (toe_off.active != 0 && !was_active) {
        ++starts;
        first_fraction = gait().time_in_phase / gait().phase_duration;
      }
      was_active = toe_off.active != 0;
      if (was_active) {
        EXPECT_EQ(toe_off.side, trailing());
        EXPECT_EQ(gait().phase, GAITD_PHASE_TRANSFER);
      }
    };
  }
  // Out of a straddle that is where the next step leaves from.
  int trailing() const {
    return gait().trailing_side != GAITD_BOTH ? gait().trailing_side : gait().next_side;
  }

  IcpCriteria layer;
  bool cmp_at_lead = true;
  bool was_active = false;
  int starts = 0;
  double first_fraction = -1.0;
};

TEST(IcpCriteria, EveryLongEnoughStepRollsOverTheToeUntilLiftOff) {
  RollingWalk w(0.1);
  ASSERT_FALSE(w.machine.walk({.steps = 5, .length = 0.35}).refused());
  w.tick();
  ASSERT_TRUE(w.run_until_stand());
  // The first step leaves from side by side; the closing one trails by a whole step.
  EXPECT_EQ(w.starts, 5);
  EXPECT_GT(w.first_fraction, 0.0);
}

TEST(IcpCriteria, AResumeInAStraddleRollsOverTheToeAsWell) {
  RollingWalk w(0.1);
  ASSERT_FALSE(w.machine.walk({.steps = 4, .length = 0.35}).refused());
  w.tick();
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_SWING, 2, 5.0));
  ASSERT_FALSE(w.machine.pause().refused());
  ASSERT_TRUE(w.run_until([&] { return w.gait().phase == GAITD_PHASE_STAND; }));
  ASSERT_EQ(w.gait().trailing_side, GAITD_BOTH);
  const int before = w.starts;
  ASSERT_FALSE(w.machine.resume().refused());
  ASSERT_TRUE(w.run_until([&] { return w.toe_off.active != 0; }));
  EXPECT_EQ(w.gait().trailing_side, GAITD_BOTH);
  w.tick();
  EXPECT_EQ(w.gait().footholds[w.gait().next_side].contact, GAITD_CONTACT_TOE);
  ASSERT_TRUE(w.run_until_stand());
  EXPECT_EQ(w.starts - before, 3);
}

TEST(IcpCriteria, AFootInToeContactCarriesLoadAtItsToeOnly) {
  RollingWalk w(0.1);
  ASSERT_FALSE(w.machine.walk({.steps = 3, .length = 0.35}).refused());
  w.tick();
  ASSERT_TRUE(w.run_until([&] { return w.toe_off.active != 0; }));
  w.tick();
  EXPECT_EQ(w.gait().footholds[w.toe_off.side].contact, GAITD_CONTACT_TOE);
}

TEST(IcpCriteria, ShortStepsStayFlat) {
  RollingWalk w(0.1);
  ASSERT_FALSE(w.machine.walk({.steps = 5, .length = 0.15}).refused());
  w.tick();
  ASSERT_TRUE(w.run_until_stand());
  EXPECT_EQ(w.starts, 0);
}

TEST(IcpCriteria, ACopAtTheHeelOrADistantCmpHoldsItBack) {
  for (bool cop : {true, false}) {
    RollingWalk w(cop ? -0.1 : 0.1);
    w.cmp_at_lead = cop;
    ASSERT_FALSE(w.machine.walk({.steps = 4, .length = 0.35}).refused());
    w.tick();
    ASSERT_TRUE(w.run_until_stand());
    EXPECT_EQ(w.starts, 0);
    EXPECT_EQ(w.toe_off.active, 0);
  }
}

TEST(IcpCriteria, TheAnkleAtItsLimitStartsItUnlessThePlanNeedsTheHeel) {
  for (const bool needed : {false, true}) {
    RollingWalk w(-0.1);
    w.planner = [&, planner = w.planner](const GaitdRobotState& robot, const GaitdGaitState& gait,
                                         GaitdIcpPlan& plan) {
      planner(robot, gait, plan);
      if (!needed || gait.trailing_side == GAITD_BOTH) return;
      const GaitdPose& trailing = gait.footholds[gait.trailing_side].pose;
      for (int k = 0; k < 2; ++k) plan.ecmp[k] = trailing.position[k];
    };
    for (const GaitdLeg& leg : atlas().legs) {
      w.robot.joint_position[leg.ankle_pitch] = leg.ankle_pitch_bend_sign * 0.7;
    }
    ASSERT_FALSE(w.machine.walk({.steps = 4, .length = 0.35}).refused());
    w.tick();
    ASSERT_TRUE(w.run_until_stand());
    EXPECT_EQ(w.starts, needed ? 0 : 4);
  }
}

// What the plan wants of the heel grows by e^(wT) until the end of the transfer.
TEST(IcpCriteria, ALongTransferKeepsItsHeelForLonger) {
  for (const double transfer : {0.2, 0.5, 1.0}) {
    RollingWalk w(0.1);
    constexpr double kBehind = 0.02;  // m, of the toe
    w.planner = [&, planner = w.planner](const GaitdRobotState& robot, const GaitdGaitState& gait,
                                         GaitdIcpPlan& plan) {
      planner(robot, gait, plan);
      if (gait.trailing_side == GAITD_BOTH) return;
      const GaitdPose& trailing = gait.footholds[gait.trailing_side].pose;
      plan.ecmp[0] = trailing.position[0] + atlas().feet[0].toe_point[0] - kBehind;
      plan.ecmp[1] = trailing.position[1];
    };
    ASSERT_FALSE(
        w.machine.walk({.steps = 4, .length = 0.35, .transfer_duration = transfer}).refused());
    w.tick();
    ASSERT_TRUE(w.run_until([&] { return w.starts == 1; }));
    const double left = w.gait().time_remaining;
    const double cost = kBehind * std::expm1(w.gait().omega * left);
    EXPECT_LT(cost, 0.031) << transfer;  // m
    EXPECT_LT(left, 0.33) << transfer;
    EXPECT_GT(left, std::min(0.8 * transfer, 0.2)) << transfer;
  }
}

}  // namespace
}  // namespace gaitd::plugins
