// SPDX-License-Identifier: Apache-2.0
#include "step_plan.h"

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

GaitdStepAdjustment process(StepPlan& layer, const SyntheticWalk& w, const GaitdRobotState& robot) {
  GaitdStepAdjustment out{};
  const GaitdToeOff toe_off{};
  const GaitdStepAdjusterInput in{sizeof(in), 0,       testing::layer_time(w.dt), &robot, &w.gait(),
                                  &w.plan,    &toe_off};
  EXPECT_EQ(layer.process(in, out), GAITD_OK);
  return out;
}
GaitdStepAdjustment process(StepPlan& layer, const SyntheticWalk& w) {
  return process(layer, w, w.robot);
}

SyntheticWalk planned_swing(double fraction = 0.5) {
  SyntheticWalk w;
  EXPECT_FALSE(w.machine.walk({.steps = 5, .length = 0.4}).refused());
  EXPECT_TRUE(w.run_until_fraction(3, fraction));  // the right foot swings
  EXPECT_EQ(w.gait().next_side, GAITD_RIGHT);
  sdk::view(w.robot.icp) = Vector2d(sdk::view(w.plan.icp)) - Vector2d(sdk::view(w.plan.offset));
  // The foot is on its way.
  const Vector2d from = sdk::view(w.gait().footholds[GAITD_RIGHT].pose.position).head<2>();
  const Vector2d to = sdk::view(w.gait().commanded[0].pose.position).head<2>();
  sdk::view(w.robot.feet[GAITD_RIGHT].position).head<2>() = from + fraction * (to - from);
  return w;
}

GaitdStepAdjustment with_error(const SyntheticWalk& w, double x, double y) {
  StepPlan layer(atlas());
  GaitdRobotState robot = w.robot;
  robot.icp[0] += x;
  robot.icp[1] += y;
  return process(layer, w, robot);
}

Vector2d foothold(const SyntheticWalk& w, const GaitdStepAdjustment& out) {
  return Vector2d(w.gait().commanded[0].pose.position[0] + out.shift[0],
                  w.gait().commanded[0].pose.position[1] + out.shift[1]);
}

TEST(StepPlan, WhatTheCmpCanDoMovesNoFoothold) {
  const SyntheticWalk w = planned_swing();
  for (const Vector2d& error : {Vector2d(0.0, 0.0), Vector2d(0.01, 0.0), Vector2d(0.0, -0.01)}) {
    const GaitdStepAdjustment out = with_error(w, error.x(), error.y());
    EXPECT_EQ(out.shift[0], 0.0);
    EXPECT_EQ(out.shift[1], 0.0);
    EXPECT_EQ(out.time_shift, 0.0);
  }
}

TEST(StepPlan, AnErrorMovesTheFootholdItsWayAndALargerOneFurther) {
  const SyntheticWalk w = planned_swing();
  double last = 0.0;
  for (double error : {0.06, 0.08, 0.1}) {
    const double shift = with_error(w, error, 0.0).shift[0];
    EXPECT_GT(shift, last) << error;
    last = shift;
  }
  EXPECT_LT(with_error(w, -0.2, 0.0).shift[0], -0.05);
  EXPECT_LT(with_error(w, 0.0, -0.15).shift[1], -0.05);  // outwards: to the right
}

TEST(StepPlan, AShockMovesNoFootholdAndAPushDoes) {
  const SyntheticWalk w = planned_swing();
  StepPlan layer(atlas());
  GaitdRobotState robot = w.robot;
  const auto shift = [&](double error) {
    robot.icp[0] = w.robot.icp[0] + error;
    return process(layer, w, robot).shift[0];
  };
  for (int i = 0; i < 50; ++i) ASSERT_EQ(shift(0.0), 0.0);
  for (double error : {0.08, 0.12, 0.04, -0.06, -0.12, -0.05}) ASSERT_EQ(shift(error), 0.0);
  double pushed = 0.0;
  for (int i = 0; i < 60; ++i) pushed = shift(0.1);
  EXPECT_GT(pushed, 0.03);
}

TEST(StepPlan, MissesLessThanAnUnchangedStepWould) {
  for (double fraction : {0.2, 0.5, 0.7}) {
    const SyntheticWalk w = planned_swing(fraction);
    const double omega = w.gait().omega;
    const double left = w.gait().time_remaining;
    // The CMP stays where the plan has it on average: only foothold and time differ.
    const Vector2d planned = sdk::view(w.robot.icp);
    const Vector2d end = sdk::view(w.plan.icp_end);
    const double tau = std::exp(omega * left);
    const Vector2d cmp = (tau * planned - end) / (tau - 1.0);
    for (double x : {-0.2, 0.1, 0.2}) {
      for (double y : {-0.2, 0.0}) {
        const GaitdStepAdjustment out = with_error(w, x, y);
        const auto missed = [&](double time, const Vector2d& shift) {
          return Vector2d(cmp + std::exp(omega * time) * (planned + Vector2d(x, y) - cmp) - end -
                          shift)
              .norm();
        };
        EXPECT_LT(missed(left + out.time_shift, {out.shift[0], out.shift[1]}),
                  missed(left, Vector2d::Zero()))
            << fraction << ": " << x << " " << y;
      }
    }
  }
}

// Of the two soles together, along and across.
Vector2d soles_apart() {
  Vector2d sum = Vector2d::Zero();
  for (const GaitdFoot& foot : atlas().feet) {
    for (int k = 0; k < 2; ++k) {
      double low = 0.0, high = 0.0;
      for (int i = 0; i < foot.point_count; ++i) {
        low = std::min(low, foot.points[i][k]);
        high = std::max(high, foot.points[i][k]);
      }
      sum[k] += 0.5 * (high - low);
    }
  }
  return sum;
}

TEST(StepPlan, SolesNeverMeetAndNoStepLeavesTheReach) {
  const Vector2d apart = soles_apart();
  for (double fraction : {0.1, 0.3, 0.5, 0.7}) {
    const SyntheticWalk w = planned_swing(fraction);
    const Vector2d stance = sdk::view(w.gait().footholds[GAITD_LEFT].pose.position).head<2>();
    const Vector2d foot = sdk::view(w.robot.feet[GAITD_RIGHT].position).head<2>();
    for (double x : {-1.5, -0.5, 0.0, 0.5, 1.5}) {
      for (double y : {-1.5, -0.3, 0.1, 0.3, 1.5}) {
        const Vector2d at = foothold(w, with_error(w, x, y));
        EXPECT_LE(at.y(), stance.y() + 1e-6);
        EXPECT_LE(stance.y() - at.y(), 0.65 * atlas().nominal_com_height + 1e-6);
        EXPECT_LE(at.x() - stance.x(), 0.85 * atlas().nominal_com_height + 1e-6);
        EXPECT_GE(at.x() - stance.x(), -0.5 * atlas().nominal_com_height - 1e-6);
        for (double way = 0.0; way <= 1.0; way += 0.01) {
          const Vector2d between = foot + way * (at - foot) - stance;
          EXPECT_FALSE(std::abs(between.x()) < apart.x() && std::abs(between.y()) < apart.y())
              << fraction << ": " << x << " " << y << " at " << way;
        }
      }
    }
  }
}

TEST(StepPlan, AFootMayLandInFrontOfTheOtherOne) {
  const SyntheticWalk w = planned_swing(0.5);
  const double stance = w.gait().footholds[GAITD_LEFT].pose.position[1];
  const Vector2d at = foothold(w, with_error(w, 0.0, 0.1));  // towards the stance foot
  EXPECT_LT(stance - at.y(), soles_apart().y());
}

TEST(StepPlan, ASwingWaitsForAFootThatHasFarToGo) {
  const SyntheticWalk w = planned_swing(0.8);
  const GaitdStepAdjustment out = with_error(w, 0.0, -0.2);  // outwards, just before touchdown
  EXPECT_GT(out.time_shift, 0.01);
  EXPECT_LE(out.time_shift, 0.5 * w.gait().phase_duration + 1e-9);
}

TEST(StepPlan, StaysInTheLandingRegion) {
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
  for (const Vector2d& error : {Vector2d(0.3, -0.3), Vector2d(0.1, 0.0), Vector2d(-0.2, 0.1)}) {
    const Vector2d at = foothold(w, with_error(w, error.x(), error.y()));
    EXPECT_GE(at.x(), x - 0.02 - 1e-6);
    EXPECT_LE(at.x(), x + 0.05 + 1e-6);
    EXPECT_GE(at.y(), y - 0.03 - 1e-6);
    EXPECT_LE(at.y(), y + 0.03 + 1e-6);
  }
  EXPECT_NEAR(foothold(w, with_error(w, 0.0, -0.3)).y(), y - 0.03, 1e-6);
}

TEST(StepPlan, ChangesNothingInTheLastMoments) {
  SyntheticWalk w = planned_swing(0.5);
  StepPlan layer(atlas());
  w.robot.icp[0] += 0.15;
  w.adjustment = process(layer, w);
  ASSERT_GT(w.adjustment.shift[0], 0.0);
  ASSERT_TRUE(w.run_until([&] { return w.gait().time_remaining < 0.03; }));
  w.robot.icp[0] = w.plan.icp[0] + 0.5;
  const GaitdStepAdjustment held = process(layer, w);
  EXPECT_EQ(held.shift[0], w.adjustment.shift[0]);
  EXPECT_EQ(held.time_shift, w.adjustment.time_shift);
}

TEST(StepPlan, AFasterSwingKeepsItsLeastDuration) {
  const SyntheticWalk w = planned_swing(0.2);
  const GaitdStepAdjustment out = with_error(w, 0.5, 0.0);
  EXPECT_LT(out.time_shift, -0.05);
  const double time = std::sqrt(atlas().nominal_com_height / atlas().gravity);
  const double shortest = testing::parameter_default<StepPlan>("shortest_swing");
  EXPECT_GE(w.gait().phase_duration + out.time_shift, shortest * time - 1e-9);
}

TEST(StepPlan, ATransferIsShortenedByALeadOfTheIcpOnly) {
  SyntheticWalk w;
  ASSERT_FALSE(w.machine.walk({.steps = 5, .length = 0.4}).refused());
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_TRANSFER, 3));
  w.tick();
  sdk::view(w.robot.icp) = Vector2d(sdk::view(w.plan.icp)) - Vector2d(sdk::view(w.plan.offset));
  EXPECT_EQ(with_error(w, 0.0, 0.0).time_shift, 0.0);
  EXPECT_EQ(with_error(w, 0.01, 0.0).time_shift, 0.0);
  EXPECT_EQ(with_error(w, -0.1, 0.0).time_shift, 0.0);
  // That CMPs could bring it back as well moves no foothold.
  const GaitdStepAdjustment small = with_error(w, 0.05, 0.0);
  EXPECT_LT(small.time_shift, -0.02);
  EXPECT_EQ(small.shift[0], 0.0);
  const GaitdStepAdjustment out = with_error(w, 0.2, 0.0);
  EXPECT_LT(out.time_shift, -0.02);
  const double time = std::sqrt(atlas().nominal_com_height / atlas().gravity);
  const double shortest = testing::parameter_default<StepPlan>("shortest_transfer");
  EXPECT_GE(w.gait().phase_duration + out.time_shift, shortest * time - 1e-9);
}

TEST(StepPlan, GoesOnFromAShiftThatAnotherVariantMade) {
  SyntheticWalk w = planned_swing();
  StepPlan first(atlas());
  w.robot.icp[0] += 0.12;
  w.adjustment = process(first, w);
  ASSERT_NE(w.adjustment.shift[0], 0.0);
  w.tick();
  GaitdStepAdjusterState state{};
  first.get_state(state);
  StepPlan second(atlas());
  second.set_state(state);
  sdk::view(w.robot.icp) = Vector2d(sdk::view(w.plan.icp)) - Vector2d(sdk::view(w.plan.offset));
  const GaitdStepAdjustment out = process(second, w);
  EXPECT_NEAR(out.time_shift, w.adjustment.time_shift, 1e-9);
}

// As beside the newcomer of a swap, which may roll back to it.
TEST(StepPlan, WhatTheGaitDoesNotFollowDoesNotAddUp) {
  SyntheticWalk w;
  ASSERT_FALSE(w.machine.walk({.steps = 5, .length = 0.4}).refused());
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_TRANSFER, 3));
  StepPlan layer(atlas());
  sdk::view(w.robot.icp) = Vector2d(sdk::view(w.plan.icp)) - Vector2d(sdk::view(w.plan.offset));
  w.robot.icp[0] += 0.2;
  const double first = process(layer, w).time_shift;
  ASSERT_LT(first, -0.02);
  for (int i = 0; i < 50; ++i) EXPECT_GT(process(layer, w).time_shift, 1.5 * first) << i;
}

TEST(StepPlan, NeverAllocates) {
  SyntheticWalk w = planned_swing();
  StepPlan layer(atlas());
  w.robot.icp[0] += 0.15;
  const int before = testing::allocation_count();
  for (int i = 0; i < 100; ++i) process(layer, w);
  EXPECT_EQ(testing::allocation_count(), before);
}

// What the problem of step_qp.h costs with foothold shift D, CMP offset d and time T, without the
// linearisation; the part of the ICP outside of the capture set comes last.
double cost(const StepProblem& p, const StepWeights& w, const Vector2d& before, double time_before,
            const Vector2d& D, const Vector2d& d, double T) {
  const double growth = std::exp(p.omega * T);
  const Vector2d ecmp = walking::ecmp_of(p.cmp + d, p.com, p.kappa);
  const Vector2d icp = ecmp + growth * (p.icp - ecmp);
  const Vector2d missed = icp - p.icp_end - p.gamma * (D - p.start_shift);
  double beyond = 0.0;
  for (int i = 0; i < CaptureSet::kDirections; ++i) {
    beyond =
        std::max(beyond, CaptureSet::direction(i).dot(icp - p.commanded - D) - p.capture.limit[i]);
  }
  const double used = 1.0 - std::exp(-p.omega * time_before);
  return (D - p.start_shift).squaredNorm() + w.cmp * used * (d / p.kappa).squaredNorm() +
         w.change * (D - before).squaredNorm() + w.missed * missed.squaredNorm() +
         w.time * std::pow(T - p.planned, 2) + w.time_change * std::pow(T - time_before, 2) +
         1e4 * beyond * beyond;
}

walking::ConvexPolygon hull(std::initializer_list<Vector2d> points) {
  walking::ConvexPolygon polygon;
  for (const Vector2d& p : points) polygon.add(p);
  polygon.make_hull();
  return polygon;
}

StepProblem example() {
  StepProblem p;
  p.com = Vector2d::Zero();
  p.cmp = Vector2d::Zero();
  p.cmp_region = hull({{-0.1, -0.05}, {0.1, -0.05}, {0.1, 0.05}, {-0.1, 0.05}});
  p.reach = hull({{-0.5, 0.0}, {0.9, 0.0}, {0.0, 0.8}});
  p.commanded = {0.4, 0.25};
  p.start_shift.setZero();
  p.foot = {0.1, 0.25};
  p.icp_end = {0.25, 0.12};
  p.gamma = 0.95;
  p.clear = {Vector2d(0.0, 1.0), 0.05};
  p.capture.limit.fill(0.3);
  p.foot_speed = 3.0;
  p.planned = 0.35;
  p.shortest = 0.1;
  p.longest = 0.6;
  return p;
}

TEST(StepQp, NoAdmissiblePointIsMuchBetterThanItsSolution) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const StepWeights w{
      .cmp = 0.1, .change = 0.1, .time = 0.04, .time_change = 0.004, .missed = 30.0};
  StepQp qp;
  for (int run = 0; run < 50; ++run) {
    StepProblem p = example();
    p.icp = {0.1 + 0.15 * unit(random), 0.05 + 0.1 * unit(random)};
    const double before = 0.3 + 0.1 * unit(random);
    const Vector2d made = Vector2d(0.1 * unit(random), 0.1 * unit(random));
    Vector2d shift = made;
    double remaining = before;
    // Solved until the linearisation is that of the solution.
    for (int i = 0; i < 20; ++i) ASSERT_TRUE(qp.solve(p, w, shift, remaining));
    EXPECT_GE(p.reach.inside_distance(p.commanded + shift), -1e-8);
    EXPECT_GE(p.clear.normal.dot(p.commanded + shift), p.clear.offset - 1e-8);
    EXPECT_GE(remaining, p.shortest - 1e-3);
    EXPECT_LE(remaining, p.longest + 1e-3);
    double here = 1e9, elsewhere = 1e9;
    for (int i = 0; i < 5000; ++i) {
      const Vector2d d = p.cmp_region.closest_point({0.15 * unit(random), 0.1 * unit(random)});
      here = std::min(here, cost(p, w, shift, remaining, shift, d, remaining));
      const double T = std::clamp(remaining + 0.2 * unit(random), p.shortest, p.longest);
      const Vector2d to =
          p.reach.closest_point(p.commanded + shift + 0.2 * Vector2d(unit(random), unit(random)));
      if (to.y() < p.clear.offset || (to - p.foot).norm() > p.foot_speed * T) continue;
      elsewhere = std::min(elsewhere, cost(p, w, shift, remaining, to - p.commanded, d, T));
    }
    EXPECT_LE(here, elsewhere + 0.1 * elsewhere + 1e-2) << run;
  }
}

TEST(StepQp, AFootholdThatIsHeldStaysAndTheTimeMakesUpForIt) {
  StepProblem p = example();
  p.icp = {0.13, 0.05};  // ahead
  p.held = true;
  const StepWeights weights{
      .cmp = 0.1, .change = 1.0, .time = 0.0, .time_change = 0.01, .missed = 80.0};
  Vector2d shift(0.02, 0.01);
  double time = 0.35;
  StepQp qp;
  ASSERT_TRUE(qp.solve(p, weights, shift, time));
  EXPECT_NEAR(shift.x(), 0.02, 1e-9);
  EXPECT_NEAR(shift.y(), 0.01, 1e-9);
  EXPECT_LT(time, 0.34);
}

TEST(StepQp, TheTransferAfterTouchdownBringsBackWhatItsFeedbackAndItsFeetCan) {
  StepProblem p = example();
  p.cmp_region = hull({{0.0, 0.0}});  // nothing before touchdown
  p.icp = {0.11, 0.05};
  const double time = 0.3;
  const Vector2d alone = p.missed(Vector2d::Zero(), time);
  LaterPhase& transfer = p.later[StepProblem::kTransfer];
  transfer.share = 0.3;
  transfer.left = 0.4;
  transfer.region = hull({{-9.0, -9.0}, {9.0, -9.0}, {9.0, 9.0}, {-9.0, 9.0}});
  EXPECT_LT((p.missed(Vector2d::Zero(), time) - 0.4 * alone).norm(), 1e-12);
  transfer.region = hull({{-0.1, -0.1}, {0.1, -0.1}, {0.1, 0.1}, {-0.1, 0.1}});
  const Vector2d bounded = alone - p.missed(Vector2d::Zero(), time);
  EXPECT_LE(bounded.cwiseAbs().maxCoeff(), 0.3 * 0.1 + 1e-12);
  EXPECT_GT(bounded.dot(alone), 0.0);
}

// The other way round: from the edge of the set one best step leads to the edge of the set of the
// other foot, and from outside of it no step leads inside.
TEST(CaptureSet, IsWhatOneStepMapsOntoTheOtherFoot) {
  const walking::ConvexPolygon sole =
      hull({{-0.1, -0.05}, {0.1, -0.05}, {0.1, 0.05}, {-0.1, 0.05}});
  const walking::ConvexPolygon right = hull({{-0.5, -0.15}, {0.9, -0.15}, {0.0, -0.7}});
  const walking::ConvexPolygon left = hull({{-0.5, 0.15}, {0.9, 0.15}, {0.0, 0.7}});
  const double growth = 2.6;
  const CaptureSet after_left(right, sole, left, sole, growth);
  const CaptureSet after_right(left, sole, right, sole, growth);
  for (int i = 0; i < CaptureSet::kDirections; ++i) {
    const Vector2d n = CaptureSet::direction(i);
    // The farthest ICP along n, the CMP as far along n as the sole allows, and the farthest step.
    const double next =
        growth * after_left.limit[i] - (growth - 1.0) * support(sole, n) - support(right, n);
    EXPECT_NEAR(next, after_right.limit[i], 1e-12) << i;
  }
  // To the side of a foot there is less room than to where the other one can step.
  EXPECT_LT(after_left.limit[CaptureSet::kDirections / 4],
            after_left.limit[3 * CaptureSet::kDirections / 4]);
}

}  // namespace
}  // namespace gaitd::plugins
