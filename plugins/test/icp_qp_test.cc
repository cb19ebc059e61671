// SPDX-License-Identifier: Apache-2.0
#include "icp_qp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "gaitd/walking/support.h"
#include "layer_inputs.h"
#include "walking/test/allocation_counter.h"

namespace gaitd::plugins {
namespace {

using Eigen::Vector2d;
using testing::atlas;
using testing::SyntheticWalk;

GaitdStepAdjustment process(IcpQp& layer, const SyntheticWalk& w, const GaitdRobotState& robot) {
  GaitdStepAdjustment out{};
  const GaitdToeOff toe_off{};
  const GaitdStepAdjusterInput in{sizeof(in), 0,       testing::layer_time(w.dt), &robot, &w.gait(),
                                  &w.plan,    &toe_off};
  EXPECT_EQ(layer.process(in, out), GAITD_OK);
  return out;
}
GaitdStepAdjustment process(IcpQp& layer, const SyntheticWalk& w) {
  return process(layer, w, w.robot);
}

SyntheticWalk in_swing(double fraction = 0.5) {
  SyntheticWalk w;
  EXPECT_FALSE(w.machine.walk({.steps = 5, .length = 0.4}).refused());
  EXPECT_TRUE(w.run_until_fraction(3, fraction));  // the right foot swings
  EXPECT_EQ(w.gait().next_side, GAITD_RIGHT);
  sdk::view(w.robot.icp) = Vector2d(sdk::view(w.plan.icp)) - Vector2d(sdk::view(w.plan.offset));
  return w;
}

GaitdStepAdjustment with_error(const SyntheticWalk& w, double x, double y) {
  IcpQp layer(atlas());
  GaitdRobotState robot = w.robot;
  robot.icp[0] += x;
  robot.icp[1] += y;
  return process(layer, w, robot);
}

Vector2d foothold(const SyntheticWalk& w, const GaitdStepAdjustment& out) {
  return Vector2d(w.gait().commanded[0].pose.position[0] + out.shift[0],
                  w.gait().commanded[0].pose.position[1] + out.shift[1]);
}

TEST(IcpQp, WhatTheCmpCanDoMovesNoFoothold) {
  const SyntheticWalk w = in_swing();
  for (const Vector2d& error : {Vector2d(0.0, 0.0), Vector2d(0.01, 0.0), Vector2d(0.0, -0.01)}) {
    const GaitdStepAdjustment out = with_error(w, error.x(), error.y());
    EXPECT_EQ(out.shift[0], 0.0);
    EXPECT_EQ(out.shift[1], 0.0);
    EXPECT_EQ(out.time_shift, 0.0);
  }
}

TEST(IcpQp, AnErrorMovesTheFootholdItsWayAndALargerOneFurther) {
  const SyntheticWalk w = in_swing();
  double last = 0.0;
  for (double error : {0.1, 0.15, 0.2}) {
    const GaitdStepAdjustment out = with_error(w, error, 0.0);
    EXPECT_GT(out.shift[0], last);
    EXPECT_LE(out.time_shift, 0.0);
    last = out.shift[0];
  }
  EXPECT_LT(with_error(w, -0.2, 0.0).shift[0], -0.05);
  EXPECT_LT(with_error(w, 0.0, -0.15).shift[1], -0.05);  // outwards: to the right
}

TEST(IcpQp, NeverCrossesTheLegsNorLeavesTheReach) {
  const SyntheticWalk w = in_swing();
  const double least = 0.75 * atlas().nominal_foot_separation;
  const double stance = w.gait().footholds[GAITD_LEFT].pose.position[1];
  for (double x : {-1.5, -0.5, 0.0, 0.5, 1.5}) {
    for (double y : {-1.5, -0.3, 0.3, 1.5}) {
      const Vector2d at = foothold(w, with_error(w, x, y));
      EXPECT_GE(stance - at.y(), least - 1e-6) << x << " " << y;
      EXPECT_LE(stance - at.y(), 0.65 * atlas().nominal_com_height + 1e-6);
      const double ahead = at.x() - w.gait().footholds[GAITD_LEFT].pose.position[0];
      EXPECT_LE(ahead, 0.85 * atlas().nominal_com_height + 1e-6);
      EXPECT_GE(ahead, -0.5 * atlas().nominal_com_height - 1e-6);
    }
  }
}

TEST(IcpQp, StaysInTheLandingRegion) {
  SyntheticWalk w;
  ASSERT_FALSE(w.machine.walk({.steps = 5, .length = 0.4}).refused());
  ASSERT_TRUE(w.run_until_fraction(2, 0.5));
  GaitdFootstep ahead[4];
  for (int i = 0; i < 4; ++i) ahead[i] = w.gait().commanded[i + 1];
  const double x = ahead[0].pose.position[0], y = ahead[0].pose.position[1];
  const double corners[4][2] = {
      {x - 0.02, y - 0.03}, {x + 0.05, y - 0.03}, {x + 0.05, y + 0.03}, {x - 0.02, y + 0.03}};
  ahead[0].region_count = 4;
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 2; ++k) ahead[0].landing_region[i][k] = corners[i][k];
  }
  ASSERT_FALSE(w.machine.footsteps(ahead, 4, true).refused());
  ASSERT_TRUE(w.run_until_fraction(3, 0.5));
  const Vector2d far = foothold(w, with_error(w, 0.3, -0.3));
  EXPECT_NEAR(far.x(), x + 0.05, 1e-6);
  EXPECT_NEAR(far.y(), y - 0.03, 1e-6);
}

TEST(IcpQp, ChangesNothingInTheLastMoments) {
  SyntheticWalk w = in_swing(0.5);
  IcpQp layer(atlas());
  w.robot.icp[0] += 0.15;
  w.adjustment = process(layer, w);
  ASSERT_GT(w.adjustment.shift[0], 0.0);
  ASSERT_TRUE(w.run_until([&] { return w.gait().time_remaining < 0.07; }));
  w.robot.icp[0] = w.plan.icp[0] + 0.5;
  const GaitdStepAdjustment held = process(layer, w);
  EXPECT_EQ(held.shift[0], w.adjustment.shift[0]);
  EXPECT_EQ(held.time_shift, w.adjustment.time_shift);
}

TEST(IcpQp, AFasterSwingKeepsItsLeastDuration) {
  const SyntheticWalk w = in_swing(0.2);
  const GaitdStepAdjustment out = with_error(w, 0.5, 0.0);
  EXPECT_LT(out.time_shift, -0.05);
  EXPECT_GE(w.gait().phase_duration + out.time_shift, 0.3 - 1e-9);
}

TEST(IcpQp, ATransferIsShortenedByALeadOfTheIcpOnly) {
  SyntheticWalk w;
  ASSERT_FALSE(w.machine.walk({.steps = 5, .length = 0.4}).refused());
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_TRANSFER, 3));
  w.tick();
  sdk::view(w.robot.icp) = Vector2d(sdk::view(w.plan.icp)) - Vector2d(sdk::view(w.plan.offset));
  EXPECT_EQ(with_error(w, 0.0, 0.0).time_shift, 0.0);
  EXPECT_EQ(with_error(w, -0.1, 0.0).time_shift, 0.0);
  const GaitdStepAdjustment out = with_error(w, 0.1, 0.0);
  EXPECT_LT(out.time_shift, -0.02);
  EXPECT_GE(w.gait().phase_duration + out.time_shift, 0.1 - 1e-9);
}

TEST(IcpQp, GoesOnFromAShiftThatAnotherVariantMade) {
  SyntheticWalk w = in_swing();
  IcpQp first(atlas());
  w.robot.icp[0] += 0.12;
  w.adjustment = process(first, w);
  ASSERT_NE(w.adjustment.shift[0], 0.0);
  w.tick();
  GaitdStepAdjusterState state{};
  first.get_state(state);
  IcpQp second(atlas());
  second.set_state(state);
  sdk::view(w.robot.icp) = Vector2d(sdk::view(w.plan.icp)) - Vector2d(sdk::view(w.plan.offset));
  const GaitdStepAdjustment out = process(second, w);
  EXPECT_NEAR(out.time_shift, w.adjustment.time_shift, 1e-9);
}

TEST(IcpQp, NeverAllocates) {
  SyntheticWalk w = in_swing();
  IcpQp layer(atlas());
  w.robot.icp[0] += 0.15;
  const int before = testing::allocation_count();
  for (int i = 0; i < 100; ++i) process(layer, w);
  EXPECT_EQ(testing::allocation_count(), before);
}

// Cost of the problem of capture_step.h at (D, d_cmp, d_am).
double cost(const Capture& c, const CaptureWeights& w, double remaining, const Vector2d& previous,
            const Vector2d& D, const Vector2d& cmp, const Vector2d& am) {
  const double growth = std::exp(c.omega * remaining);
  const Vector2d ecmp = c.ecmp_of(c.cmp + cmp + am);
  const Vector2d s = ecmp + growth * (c.icp - ecmp) - c.icp_end - c.gamma_end * (D - c.start_shift);
  return w.shift * (D - c.start_shift).squaredNorm() + w.cmp * cmp.squaredNorm() +
         w.angular * am.squaredNorm() + w.change * (D - previous).squaredNorm() +
         w.slack * s.squaredNorm();
}

TEST(CaptureQp, NoPointIsBetterThanItsSolution) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  Capture c;
  for (const Vector2d& p :
       {Vector2d(-0.1, -0.05), Vector2d(0.1, -0.05), Vector2d(0.1, 0.05), Vector2d(-0.1, 0.05)}) {
    c.cmp_region.add(p);
  }
  c.cmp_region.make_hull();
  for (const Vector2d& p : {Vector2d(-0.5, 0.18), Vector2d(0.9, 0.18), Vector2d(0.0, 0.8)}) {
    c.reach.add(p);
  }
  c.reach.make_hull();
  c.commanded = {0.4, 0.25};
  c.icp_end = {0.25, 0.12};
  c.gamma_end = 0.95;
  const CaptureWeights w{1.0, 0.1, 20.0, 0.1, 200.0, 0.03};
  CaptureQp qp;
  for (int run = 0; run < 50; ++run) {
    c.icp = {0.1 + 0.15 * unit(random), 0.05 + 0.1 * unit(random)};
    const double remaining = 0.3 + 0.2 * unit(random);
    const Vector2d previous(0.1 * unit(random), 0.1 * unit(random));
    Vector2d shift = previous;
    ASSERT_TRUE(qp.solve(c, w, remaining, previous, shift));
    EXPECT_GE(c.reach.inside_distance(c.commanded + shift), -1e-8);
    // The best CMP for the solution's shift and for random ones: random search over both.
    double best_at_solution = 1e9, best_elsewhere = 1e9;
    for (int i = 0; i < 4000; ++i) {
      const Vector2d cmp = c.cmp_region.closest_point({0.15 * unit(random), 0.1 * unit(random)});
      const Vector2d am(0.03 * unit(random), 0.03 * unit(random));
      const Vector2d other = c.possible_shift(shift + 0.1 * Vector2d(unit(random), unit(random)));
      best_at_solution =
          std::min(best_at_solution, cost(c, w, remaining, previous, shift, cmp, am));
      best_elsewhere = std::min(best_elsewhere, cost(c, w, remaining, previous, other, cmp, am));
    }
    EXPECT_LE(best_at_solution, best_elsewhere + 2e-2) << run;
  }
}

}  // namespace
}  // namespace gaitd::plugins
