// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <vector>

#include "fixed_steps.h"
#include "gaitd/walking/support.h"
#include "layer_inputs.h"
#include "walking/test/allocation_counter.h"

namespace gaitd::plugins {
namespace {

using Eigen::Vector2d;
using testing::atlas;
using testing::SyntheticWalk;

// A layer whose feedback is proportional only and whose kappa follows at once.
class Adjuster {
 public:
  Adjuster() : layer(atlas()) {
    if (testing::parameter_index<FixedSteps>("integral_standing") >= 0) {
      testing::set_parameter(layer, "integral_standing", 0.0);
    }
    testing::set_parameter(layer, "kappa_filter", 500.0);
    testing::set_parameter(layer, "gain_parallel", 4.0);
    testing::set_parameter(layer, "gain_orthogonal", 2.0);
    testing::set_parameter(layer, "gain_standing", 3.0);
    testing::set_parameter(layer, "margin", 0.01);
    testing::set_parameter(layer, "excursion", 0.03);
    testing::set_parameter(layer, "delay", 0.0);
  }
  GaitdStepAdjustment process(const SyntheticWalk& w, int ticks = 30) {
    GaitdStepAdjustment out{};
    const GaitdToeOff toe_off{};
    for (int i = 0; i < ticks; ++i) {
      const GaitdStepAdjusterInput in{
          sizeof(in), 0, testing::layer_time(w.dt), &w.robot, &w.gait(), &w.plan, &toe_off};
      EXPECT_EQ(layer.process(in, out), GAITD_OK);
    }
    return out;
  }
  FixedSteps layer;
};

SyntheticWalk in_swing() {
  SyntheticWalk w;
  EXPECT_FALSE(w.machine.walk({.steps = 4, .length = 0.3}).refused());
  EXPECT_TRUE(w.run_until_fraction(2, 0.5));
  return w;
}

double kappa_of(const SyntheticWalk& w) {
  return w.robot.com[2] * w.gait().omega * w.gait().omega / atlas().gravity;
}

TEST(FixedSteps, WithoutAnErrorTheReferenceIsPassedOn) {
  SyntheticWalk w;
  w.run_for(0.1);
  sdk::view(w.robot.icp) = sdk::view(w.plan.icp);
  sdk::view(w.plan.ecmp) = sdk::view(w.plan.icp);
  const GaitdStepAdjustment out = Adjuster().process(w);
  EXPECT_LT((Vector2d(sdk::view(out.ecmp)) - Vector2d(sdk::view(w.plan.ecmp))).norm(), 1e-12);
  EXPECT_EQ(out.active, 0);
  EXPECT_EQ(out.shift[0], 0.0);
  EXPECT_EQ(out.time_shift, 0.0);
  EXPECT_EQ(out.angular_momentum_mask, 0);
}

TEST(FixedSteps, StandingFeedbackIsTheClosedFormInEveryDirection) {
  SyntheticWalk w;
  w.run_for(0.1);
  for (const Vector2d& error :
       {Vector2d(0.01, 0.0), Vector2d(0.0, 0.012), Vector2d(-0.008, 0.006)}) {
    sdk::view(w.robot.icp) = Vector2d(sdk::view(w.plan.icp)) + error;
    const GaitdStepAdjustment out = Adjuster().process(w);
    const Vector2d expected =
        Vector2d(sdk::view(w.plan.ecmp)) + (1.0 + 3.0 / w.gait().omega) * error;
    EXPECT_LT((Vector2d(sdk::view(out.ecmp)) - expected).norm(), 1e-9);
  }
}

TEST(FixedSteps, WalkingFeedbackDiffersAlongAndAcrossTheMotionOfTheReference) {
  SyntheticWalk w = in_swing();
  const double omega = w.gait().omega;
  const Vector2d direction = Vector2d(sdk::view(w.plan.icp_velocity)).normalized();
  const Vector2d normal(-direction.y(), direction.x());
  for (const auto& [along, across] : {std::pair{0.006, 0.0}, {0.0, 0.006}, {-0.004, 0.003}}) {
    sdk::view(w.robot.icp) = Vector2d(sdk::view(w.plan.icp)) + along * direction + across * normal;
    const GaitdStepAdjustment out = Adjuster().process(w);
    const Vector2d expected = Vector2d(sdk::view(w.plan.ecmp)) +
                              (1.0 + 4.0 / omega) * along * direction +
                              (1.0 + 2.0 / omega) * across * normal;
    EXPECT_LT((Vector2d(sdk::view(out.ecmp)) - expected).norm(), 1e-6) << along << " " << across;
  }
}

TEST(FixedSteps, ASlowReferenceKeepsTheLastDirection) {
  SyntheticWalk w = in_swing();
  Adjuster adjuster;
  w.plan.icp_velocity[0] = 0.4;
  w.plan.icp_velocity[1] = 0.0;
  adjuster.process(w);
  w.plan.icp_velocity[0] = 0.0;
  w.plan.icp_velocity[1] = 0.01;  // slow: no direction
  sdk::view(w.robot.icp) = Vector2d(sdk::view(w.plan.icp)) + Vector2d(0.005, 0.0);
  const GaitdStepAdjustment out = adjuster.process(w);
  EXPECT_NEAR(out.ecmp[0] - w.plan.ecmp[0], (1.0 + 4.0 / w.gait().omega) * 0.005, 1e-6);
}

TEST(FixedSteps, TheCmpBelongsToTheEcmpByKappa) {
  SyntheticWalk w = in_swing();
  sdk::view(w.robot.icp) = Vector2d(sdk::view(w.plan.icp));
  const GaitdStepAdjustment out = Adjuster().process(w);
  const Vector2d com = Vector2d(w.robot.com[0], w.robot.com[1]);
  EXPECT_NEAR(out.kappa, kappa_of(w), 1e-6);
  const Vector2d ecmp = sdk::view(out.ecmp);
  const Vector2d cmp = sdk::view(out.cmp);
  EXPECT_LT((out.kappa * (com - ecmp) - (com - cmp)).norm(), 1e-12);
  const double omega = w.gait().omega;
  const Vector2d rate = sdk::view(out.linear_momentum_rate);
  EXPECT_LT((rate - atlas().total_mass * omega * omega * (com - ecmp)).norm(), 1e-9);
}

// Theory section 1: a stride of 0.75 of the pendulum's length, 27 mm of one of 1 m, at the exchange
// of support.
TEST(FixedSteps, APendulumAtTheExchangeOfSupportHasItsCmp27MillimetresFromItsEcmp) {
  SyntheticWalk w;
  const double z = atlas().gravity / (w.gait().omega * w.gait().omega);
  const double l = 0.75 * z;
  const double expected = 0.5 * l * (1.0 - std::sqrt(z * z - 0.25 * l * l) / z);
  ASSERT_NEAR(expected / z, 0.027, 5e-4);
  w.run_for(0.01);
  w.robot.com[0] = -0.5 * l;  // half a stride behind the CMP, which is under the feet
  w.robot.com[1] = 0.0;
  w.robot.com[2] = std::sqrt(z * z - 0.25 * l * l);
  w.plan.ecmp[0] = w.plan.ecmp[1] = 0.0;
  sdk::view(w.robot.icp) = sdk::view(w.plan.icp);
  const GaitdStepAdjustment out = Adjuster().process(w);
  ASSERT_NEAR(out.ecmp[0], 0.0, 1e-9);
  EXPECT_NEAR(std::abs(out.cmp[0] - out.ecmp[0]), expected, 1e-6);
}

// ICP error along x after `time` seconds when commands act `ticks` later (m); it begins at 1 cm.
double error_after(double time, int ticks, double known_delay) {
  SyntheticWalk w;
  w.run_for(0.1);
  Adjuster a;
  testing::set_parameter(a.layer, "delay", known_delay);
  testing::set_parameter(a.layer, "gain_standing", 20.0);
  const double growth = std::exp(w.gait().omega * w.dt);
  std::vector<double> on_their_way(ticks, 0.0);
  double error = 0.01;
  for (int i = 0; i < std::lround(time / w.dt); ++i) {
    sdk::view(w.robot.icp) = sdk::view(w.plan.icp) + Vector2d(error, 0.0);
    on_their_way.push_back(a.process(w, 1).ecmp[0] - w.plan.ecmp[0]);
    const double acts = on_their_way[on_their_way.size() - 1 - ticks];
    error = acts + growth * (error - acts);
  }
  return error;
}

TEST(FixedSteps, AKnownDelayIsPredictedAway) {
  const double instant = error_after(0.1, 0, 0.0);
  EXPECT_NEAR(instant, 0.01 * std::exp(-20.0 * 0.1), 2e-4);
  // Until the first command acts the error grows; from there on it goes as without a delay.
  const double growth = std::exp(3.0 * 0.015);
  const double predicted = error_after(0.115, 15, 0.015);
  EXPECT_NEAR(predicted, growth * instant, 1e-4);
  EXPECT_GT(std::abs(error_after(0.115, 15, 0.0) - growth * instant), 3e-4);
}

TEST(FixedSteps, KappaIsClamped) {
  for (const auto& [height, name] : {std::pair{0.2, "kappa_min"}, {3.0, "kappa_max"}}) {
    SyntheticWalk w;
    w.run_for(0.01);
    w.robot.com[2] = height;
    EXPECT_NEAR(Adjuster().process(w, 100).kappa, testing::parameter_default<FixedSteps>(name),
                1e-9);
  }
}

TEST(FixedSteps, KappaIsMeasuredFromTheGroundUnderTheFeet) {
  SyntheticWalk w;
  for (GaitdFootState& foot : w.robot.feet) foot.position[2] = 0.6;
  w.robot.com[2] += 0.6;
  w.machine.reset(w.robot);
  w.planner(w.robot, w.gait(), w.plan);
  EXPECT_NEAR(Adjuster().process(w).kappa,
              (w.robot.com[2] - 0.6) * w.gait().omega * w.gait().omega / atlas().gravity, 1e-6);
}

TEST(FixedSteps, TheCmpStaysInTheShrunkPolygonPlusTheExcursionWhateverTheError) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal(0.0, 0.3);
  SyntheticWalk walking = in_swing();
  SyntheticWalk standing;
  standing.run_for(0.1);
  int limited = 0;
  for (SyntheticWalk* w : {&walking, &standing}) {
    const walking::ConvexPolygon polygon = walking::support_polygon(atlas(), w->gait());
    const Vector2d reference = sdk::view(w->plan.icp);
    for (int run = 0; run < 300; ++run) {
      sdk::view(w->robot.icp) = reference + Vector2d(normal(random), normal(random));
      const GaitdStepAdjustment out = Adjuster().process(*w, 2);
      const walking::ConvexPolygon region = polygon.inset(0.01);
      const Vector2d beyond =
          Vector2d(sdk::view(out.cmp)) - region.closest_point(sdk::view(out.cmp));
      const double most =
          w == &standing ? walking::IcpFeedback::kStandingExcursion * atlas().nominal_com_height
                         : 0.03;
      EXPECT_LE(beyond.norm(), most + 1e-9);
      limited += beyond.norm() > most - 1e-4 ? 1 : 0;
      // Angular momentum is asked for as such where no step answers.
      const double force = atlas().total_mass * atlas().gravity;
      const Eigen::Vector3d rate = sdk::view(out.angular_momentum_rate);
      EXPECT_EQ(out.angular_momentum_mask, w == &standing && beyond.norm() > 0.0 ? 0b011 : 0);
      if (w == &standing) {
        EXPECT_NEAR(rate.x(), -force * beyond.y(), 1e-6);
        EXPECT_NEAR(rate.y(), force * beyond.x(), 1e-6);
      }
    }
  }
  EXPECT_GT(limited, 100);
}

TEST(FixedSteps, StateGoesOnInAnotherInstance) {
  SyntheticWalk w = in_swing();
  Adjuster a;
  a.process(w);
  GaitdStepAdjusterState state{};
  a.layer.get_state(state);
  EXPECT_EQ(state.size, sizeof(state));
  Adjuster b;
  b.layer.set_state(state);
  const GaitdStepAdjustment x = a.process(w, 1);
  const GaitdStepAdjustment y = b.process(w, 1);
  EXPECT_TRUE(std::ranges::equal(std::as_bytes(std::span(&x, 1)), std::as_bytes(std::span(&y, 1))));
}

TEST(FixedSteps, WhatMovedAStepOfAnotherWalkMovesNone) {
  SyntheticWalk w = in_swing();
  GaitdStepAdjusterState state{};
  state.step_index = w.gait().step_index + 1;
  state.shift[0] = 0.1;
  state.time_shift = -0.3;
  Adjuster a;
  a.layer.set_state(state);
  EXPECT_EQ(a.process(w).active, 0);
  state.step_index = w.gait().step_index;
  Adjuster b;
  b.layer.set_state(state);
  EXPECT_EQ(b.process(w).time_shift, -0.3);
}

TEST(FixedSteps, NeverAllocates) {
  SyntheticWalk w = in_swing();
  Adjuster adjuster;
  const int before = testing::allocation_count();
  adjuster.process(w, 100);
  EXPECT_EQ(testing::allocation_count(), before);
}

}  // namespace
}  // namespace gaitd::plugins
