// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "heel_to_toe.h"
#include "layer_inputs.h"
#include "single_cmp.h"
#include "walking/test/allocation_counter.h"
#include "walking/test/command_storm.h"

namespace gaitd::plugins {
namespace {

using testing::atlas;
using testing::CommandStorm;
using testing::planned_by;
using testing::SyntheticWalk;

template <class Planner>
class IcpPlanner : public ::testing::Test {};
using Planners = ::testing::Types<HeelToToe, SingleCmp>;
TYPED_TEST_SUITE(IcpPlanner, Planners);

TYPED_TEST(IcpPlanner, ReferenceNeverJumpsUnderRandomCommands) {
  for (unsigned seed = 300; seed < 304; ++seed) {
    SyntheticWalk w;
    TypeParam planner(atlas());
    w.planner = planned_by(planner, w.dt);
    CommandStorm storm(seed);
    Eigen::Vector2d predicted = Eigen::Vector2d::Zero();
    double worst = 0.0;
    double dynamics = 0.0;
    for (int i = 0; i < 10000; ++i) {
      storm.disturb(w);
      w.tick();
      const Eigen::Vector2d icp = sdk::view(w.plan.icp);
      const Eigen::Vector2d rate = sdk::view(w.plan.icp_velocity);
      if (i > 0) worst = std::max(worst, (icp - predicted).norm());
      dynamics = std::max(
          dynamics,
          (rate - w.gait().omega * (icp - Eigen::Vector2d(sdk::view(w.plan.ecmp)))).norm());
      predicted = icp + w.dt * rate;
    }
    EXPECT_LT(worst, 1e-3) << seed;
    EXPECT_LT(dynamics, 1e-9) << seed;
    EXPECT_GT(w.gait().step_index, 2);
  }
}

TYPED_TEST(IcpPlanner, ReferenceCmpStaysUnderTheFeetInAnUndisturbedWalk) {
  SyntheticWalk w;
  TypeParam planner(atlas());
  w.planner = planned_by(planner, w.dt);
  ASSERT_FALSE(w.machine.walk({.steps = 5, .length = 0.35}).refused());
  w.tick();
  double outside = 0.0;
  ASSERT_TRUE(w.run_until([&] {
    const walking::ConvexPolygon polygon = walking::support_polygon(atlas(), w.gait());
    outside = std::max(outside, -polygon.inside_distance(sdk::view(w.plan.ecmp)));
    return w.gait().phase == GAITD_PHASE_STAND;
  }));
  EXPECT_LT(outside, 0.01);
}

TYPED_TEST(IcpPlanner, PlanIsCompleteAndOfThisPhase) {
  SyntheticWalk w;
  TypeParam planner(atlas());
  w.planner = planned_by(planner, w.dt);
  ASSERT_FALSE(w.machine.walk({.steps = 5, .length = 0.35}).refused());
  ASSERT_TRUE(w.run_until_fraction(2, 0.5));
  EXPECT_EQ(w.plan.size, sizeof(GaitdIcpPlan));
  EXPECT_EQ(w.plan.time_remaining, w.gait().time_remaining);
  EXPECT_GT(w.plan.kappa, 0.5);
  EXPECT_LT(w.plan.kappa, 2.0);
  EXPECT_GT(w.plan.gamma[0], 0.0);
  EXPECT_GT(w.plan.icp_end[0], w.plan.icp[0]);  // forwards
}

TYPED_TEST(IcpPlanner, AResetForgetsTheOldReference) {
  SyntheticWalk w;
  TypeParam used(atlas());
  w.planner = planned_by(used, w.dt);
  ASSERT_FALSE(w.machine.walk({.steps = 2, .length = 0.3}).refused());
  ASSERT_TRUE(w.run_until_fraction(2, 0.5));
  used.reset();
  TypeParam fresh(atlas());
  GaitdIcpPlan a{};
  GaitdIcpPlan b{};
  planned_by(used, w.dt)(w.robot, w.gait(), a);
  planned_by(fresh, w.dt)(w.robot, w.gait(), b);
  EXPECT_EQ(std::memcmp(&a, &b, sizeof(a)), 0);
}

TYPED_TEST(IcpPlanner, NeverAllocates) {
  SyntheticWalk w;
  TypeParam planner(atlas());
  int allocations = 0;
  w.planner = [&](const GaitdRobotState& robot, const GaitdGaitState& gait, GaitdIcpPlan& plan) {
    const GaitdIcpPlannerInput in{sizeof(in), 0, testing::layer_time(w.dt), &robot, &gait};
    const int before = testing::allocation_count();
    planner.process(in, plan);
    allocations += testing::allocation_count() - before;
  };
  ASSERT_FALSE(w.machine.walk({.steps = 20, .length = 0.3}).refused());
  w.run_for(5.0);
  EXPECT_EQ(allocations, 0);
}

// The CMP of a swing, from its first to its last moment (m, along the walk).
template <class Planner>
double cmp_travel(double length) {
  SyntheticWalk w;
  Planner planner(atlas());
  w.planner = planned_by(planner, w.dt);
  EXPECT_FALSE(w.machine.walk({.steps = 6, .length = length}).refused());
  EXPECT_TRUE(w.run_until_phase(GAITD_PHASE_SWING, 4));
  const double begin = w.plan.ecmp[0];
  EXPECT_TRUE(w.run_until_fraction(4, 0.99));
  return w.plan.ecmp[0] - begin;
}

TEST(HeelToToe, CmpTravelsFromHeelToToeInALongStep) { EXPECT_GT(cmp_travel<HeelToToe>(0.4), 0.05); }

TEST(SingleCmp, CmpRestsDuringSwing) { EXPECT_LT(std::abs(cmp_travel<SingleCmp>(0.4)), 1e-3); }

}  // namespace
}  // namespace gaitd::plugins
