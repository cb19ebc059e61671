// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/icp_trajectory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "gaitd/walking/support.h"
#include "walking/test/synthetic_walk.h"

namespace gaitd::walking {
namespace {

using testing::atlas;
using testing::footstep;
using testing::SyntheticWalk;

// Walking straight ahead, in the middle of step 2.
GaitdGaitState in_swing(double length = 0.4, int steps = 6) {
  SyntheticWalk walk;
  WalkCommand command{.steps = steps, .length = length};
  EXPECT_FALSE(walk.machine.walk(command).refused());
  EXPECT_TRUE(walk.run_until_fraction(2, 0.3));
  return walk.gait();
}

IcpTrajectory built(const GaitdGaitState& gait) {
  IcpTrajectory trajectory;
  trajectory.build(atlas(), gait, CmpOffsets(atlas().nominal_com_height));
  return trajectory;
}

TEST(IcpTrajectory, ObeysTheIcpDynamicsAlongAPiece) {
  GaitdGaitState gait = in_swing();
  for (int phase : {GAITD_PHASE_SWING, GAITD_PHASE_TRANSFER}) {
    gait.phase = phase;
    gait.trailing_side = phase == GAITD_PHASE_TRANSFER ? gait.next_side : gait.trailing_side;
    const IcpTrajectory t = built(gait);
    const double h = 1e-5;
    for (double left = 0.05; left < gait.phase_duration - 0.01; left += 0.05) {
      const auto s = t.evaluate(left);
      const Eigen::Vector2d rate = (t.evaluate(left - h).icp - t.evaluate(left + h).icp) / (2 * h);
      EXPECT_LT((rate - gait.omega * (s.icp - s.ecmp)).norm(), 1e-7) << phase << " " << left;
      EXPECT_LT((rate - s.icp_velocity).norm(), 1e-7);
      EXPECT_GT(rate.norm(), 1e-3);  // or the comparison shows nothing
    }
  }
}

TEST(IcpTrajectory, TheCmpMovesLinearlyFromEntryToExitOfTheStanceFoot) {
  const GaitdGaitState gait = in_swing();
  const IcpTrajectory t = built(gait);
  const int side = gait.support;
  const GaitdFoothold landing = foothold_of(atlas(), gait.adjusted[0]);
  const Eigen::Vector2d entry =
      entry_cmp(gait.footholds[side], side, CmpOffsets(atlas().nominal_com_height));
  const Eigen::Vector2d exit =
      exit_cmp(gait.footholds[side], side, &landing, CmpOffsets(atlas().nominal_com_height));
  EXPECT_LT((t.evaluate(gait.phase_duration).ecmp - entry).norm(), 1e-12);
  EXPECT_LT((t.evaluate(0.0).ecmp - exit).norm(), 1e-12);
  EXPECT_LT((t.evaluate(0.5 * gait.phase_duration).ecmp - 0.5 * (entry + exit)).norm(), 1e-12);
  EXPECT_GT((exit - entry).x(), 0.0);  // heel to toe
}

TEST(IcpTrajectory, EntryAndExitLieInsideTheFootholdByTheMargin) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int run = 0; run < 200; ++run) {
    CmpOffsets o(atlas().nominal_com_height);
    o.entry_x = 2 * uniform(random);
    o.entry_y = 2 * uniform(random);
    o.exit_x = 2 * uniform(random);
    o.exit_y = 2 * uniform(random);
    o.margin = 0.015;
    const int side = run % 2;
    const GaitdFootstep here = footstep(side, uniform(random), uniform(random), 0, uniform(random));
    const GaitdFoothold foothold = foothold_of(atlas(), here);
    const GaitdFoothold next = foothold_of(
        atlas(), footstep(other_side(side), uniform(random), uniform(random), 0, uniform(random)));
    ConvexPolygon sole;
    add_foothold(foothold, atlas().feet[side].toe_point, sole);
    sole.make_hull();
    EXPECT_GE(sole.inside_distance(entry_cmp(foothold, side, o)), o.margin - 1e-9);
    EXPECT_GE(sole.inside_distance(exit_cmp(foothold, side, &next, o)), o.margin - 1e-9);
    EXPECT_GE(sole.inside_distance(exit_cmp(foothold, side, nullptr, o)), o.margin - 1e-9);
  }
}

TEST(IcpTrajectory, PositiveSidewaysOffsetsPointTowardsTheOtherFoot) {
  CmpOffsets o(atlas().nominal_com_height);
  o.entry_y = o.exit_y = 0.3;
  for (int side : {GAITD_LEFT, GAITD_RIGHT}) {
    const GaitdFoothold foothold = foothold_of(atlas(), footstep(side, 0, 0));
    EXPECT_LT(side_sign(side) * entry_cmp(foothold, side, o).y(), -0.01);
    EXPECT_LT(side_sign(side) * exit_cmp(foothold, side, nullptr, o).y(), -0.01);
  }
}

TEST(IcpTrajectory, APartialFootholdKeepsItsCmpsOnTheLoadablePart) {
  GaitdFootstep step = footstep(GAITD_LEFT, 1, 2);
  const double half[4][2] = {{0.13, -0.06}, {0.13, 0.06}, {0.0, 0.06}, {0.0, -0.06}};
  step.polygon_count = 4;
  for (int i = 0; i < 4; ++i) {
    step.contact_polygon[i][0] = half[i][0];
    step.contact_polygon[i][1] = half[i][1];
  }
  const GaitdFoothold foothold = foothold_of(atlas(), step);
  CmpOffsets o(atlas().nominal_com_height);
  o.entry_x = -1.0;
  EXPECT_NEAR(entry_cmp(foothold, GAITD_LEFT, o).x(), 1.0 + o.margin, 1e-12);
}

TEST(IcpTrajectory, AFootholdThatIsNoRectangleKeepsItsCmpsInside) {
  GaitdFootstep step = footstep(GAITD_LEFT, 1, 2, 0, 0.4);
  const double triangle[3][2] = {{0.13, -0.064}, {0.13, 0.064}, {-0.13, 0.064}};
  step.polygon_count = 3;
  for (int i = 0; i < 3; ++i) {
    step.contact_polygon[i][0] = triangle[i][0];
    step.contact_polygon[i][1] = triangle[i][1];
  }
  const GaitdFoothold foothold = foothold_of(atlas(), step);
  ConvexPolygon sole;
  add_foothold(foothold, atlas().feet[GAITD_LEFT].toe_point, sole);
  sole.make_hull();
  const CmpOffsets o(
      atlas().nominal_com_height);  // of a whole sole: the entry lies outside of the triangle
  EXPECT_GE(sole.inside_distance(entry_cmp(foothold, GAITD_LEFT, o)), o.margin - 1e-9);
  EXPECT_GE(sole.inside_distance(exit_cmp(foothold, GAITD_LEFT, nullptr, o)), o.margin - 1e-9);
}

// The reference of the pure plan, tick by tick, without any blending.
TEST(IcpTrajectory, IsContinuousOverEveryPhaseOfAnUndisturbedWalkAndEndsAtRest) {
  SyntheticWalk walk;
  Eigen::Vector2d last = Eigen::Vector2d::Zero();
  Eigen::Vector2d predicted = last;
  double worst = 0.0;
  int compared = 0;
  bool have_last = false;
  walk.planner = [&](const GaitdRobotState&, const GaitdGaitState& gait, GaitdIcpPlan& plan) {
    const IcpTrajectory t = built(gait);
    Eigen::Vector2d icp = t.rest();
    Eigen::Vector2d velocity = Eigen::Vector2d::Zero();
    if (!t.empty()) {
      const auto s = t.evaluate(gait.time_remaining);
      icp = s.icp;
      velocity = s.icp_velocity;
    }
    // The first transfer starts where the plan wants to, not where the robot stands.
    const bool start = gait.phase == GAITD_PHASE_TRANSFER && gait.step_index == 1;
    if (have_last && !start) {
      worst = std::max(worst, (icp - predicted).norm());
      ++compared;
    }
    have_last = !start || gait.time_in_phase > 0.0;
    last = icp;
    predicted = icp + 0.001 * velocity;
    sdk::view(plan.icp) = icp;
  };
  ASSERT_FALSE(walk.machine.walk({.steps = 5, .length = 0.4}).refused());
  ASSERT_TRUE(walk.run_until([&] { return walk.gait().phase != GAITD_PHASE_STAND; }));
  ASSERT_TRUE(walk.run_until_stand());
  EXPECT_GT(compared, 4000);
  EXPECT_LT(worst, 1e-4);
  const GaitdGaitState& end = walk.gait();
  EXPECT_LT((last - middle(end.footholds[0], end.footholds[1])).norm(), 1e-9);
}

TEST(IcpTrajectory, EndsAtRestMidwayBetweenTheLastFeet) {
  GaitdGaitState gait = in_swing(0.4, 1);
  ASSERT_EQ(gait.footstep_count, 1);
  gait.phase = GAITD_PHASE_TRANSFER;
  gait.transfer_final = 1;
  gait.trailing_side = gait.support;
  gait.phase_duration = gait.final_transfer_duration;
  const IcpTrajectory t = built(gait);
  const auto s = t.evaluate(0.0);
  EXPECT_LT((s.icp - middle(gait.footholds[0], gait.footholds[1])).norm(), 1e-12);
  EXPECT_LT(s.icp_velocity.norm(), 1e-12);
}

TEST(IcpTrajectory, StandingHasNoPieceAndRestsBetweenTheFeet) {
  SyntheticWalk walk;
  const IcpTrajectory t = built(walk.gait());
  EXPECT_TRUE(t.empty());
  EXPECT_LT((t.rest() - middle(walk.gait().footholds[0], walk.gait().footholds[1])).norm(), 1e-15);
  EXPECT_EQ(t.gamma(0, 0.1), 0.0);
}

TEST(IcpTrajectory, GammaIsTheDerivativeByAFootstepAndAllLaterOnes) {
  const GaitdGaitState gait = in_swing(0.5);
  ASSERT_GE(gait.footstep_count, 4);
  const IcpTrajectory t = built(gait);
  for (int i = 0; i < gait.footstep_count; ++i) {
    for (int axis = 0; axis < 2; ++axis) {
      const double h = 1e-4;
      GaitdGaitState moved = gait;
      for (int j = i; j < gait.footstep_count; ++j) moved.adjusted[j].pose.position[axis] += h;
      const IcpTrajectory m = built(moved);
      for (double left : {0.0, 0.1, 0.3, 0.6}) {
        const Eigen::Vector2d slope = (m.evaluate(left).icp - t.evaluate(left).icp) / h;
        // A closing step stands beside the last: moving it alone moves the exit of that foothold,
        // which is a matter of the step's length and no translation.
        if (axis == 0 && gait.adjusted[i].closing != 0) continue;
        EXPECT_NEAR(slope[axis], t.gamma(i, left), 1e-6) << "footstep " << i << " left " << left;
        EXPECT_NEAR(slope[1 - axis], 0.0, 1e-6);
      }
    }
  }
  EXPECT_GT(t.gamma(0, 0.0), 0.2);
  EXPECT_GT(t.gamma(0, 0.0), t.gamma(0, 0.6));
  EXPECT_GT(t.gamma(0, 0.0), t.gamma(1, 0.0));
}

TEST(IcpTrajectory, TheLastFootstepMovesTheRestingPlaceByHalf) {
  const GaitdGaitState gait = in_swing(0.4, 1);
  ASSERT_EQ(gait.footstep_count, 1);
  const IcpTrajectory t = built(gait);
  const double h = 1e-4;
  GaitdGaitState moved = gait;
  moved.adjusted[0].pose.position[1] += h;
  const IcpTrajectory m = built(moved);
  EXPECT_NEAR(m.rest().y(), t.rest().y(), 1e-12);  // that of the feet on the ground
  for (double left : {0.0, 0.2}) {
    const double slope = (m.evaluate(left).icp.y() - t.evaluate(left).icp.y()) / h;
    EXPECT_NEAR(slope, t.gamma(0, left), 1e-6);
    EXPECT_GT(slope, 1e-3);
    EXPECT_LT(slope, 0.5);
  }
}

TEST(IcpTrajectory, FittedStartBeginsAtTheMeasuredIcp) {
  SyntheticWalk walk;
  ASSERT_FALSE(walk.machine.walk({.steps = 3, .length = 0.3}).refused());
  walk.tick();
  ASSERT_EQ(walk.gait().phase, GAITD_PHASE_TRANSFER);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-0.02, 0.02);
  for (int run = 0; run < 50; ++run) {
    IcpTrajectory t = built(walk.gait());
    const Eigen::Vector2d end = t.evaluate(0.0).icp;
    const Eigen::Vector2d measured = t.rest() + Eigen::Vector2d(uniform(random), uniform(random));
    t.fit_start(measured, 10.0);
    EXPECT_LT((t.evaluate(walk.gait().phase_duration).icp - measured).norm(), 1e-12);
    EXPECT_LT((t.evaluate(0.0).icp - end).norm(), 1e-12);  // the rest of the plan stays
  }
}

TEST(IcpTrajectory, FittedStartStaysWithinItsLimit) {
  SyntheticWalk walk;
  ASSERT_FALSE(walk.machine.walk({.steps = 3, .length = 0.3}).refused());
  walk.tick();
  IcpTrajectory t = built(walk.gait());
  const Eigen::Vector2d before = t.start();
  t.fit_start(t.rest() + Eigen::Vector2d(0.5, 0.3), 0.05);
  EXPECT_NEAR((t.start() - before).norm(), 0.05, 1e-12);
}

TEST(IcpTrajectory, AFittedLastTransferKeepsTheIcpOfTheSwingBeforeIt) {
  GaitdGaitState gait = in_swing();
  gait.footstep_count = 1;
  IcpTrajectory t = built(gait);
  const double left = 0.6 * gait.phase_duration;
  const Eigen::Vector2d planned = t.evaluate(left).icp;
  for (const Eigen::Vector2d& off : {Eigen::Vector2d(0.02, -0.01), Eigen::Vector2d(-0.03, 0.0)}) {
    t.fit_last_start(planned + off, left, {});
    EXPECT_LT((t.evaluate(left).icp - planned - off).norm(), 1e-12);
  }
  ConvexPolygon region;
  for (const double x : {-0.01, 0.01}) {
    for (const double y : {-0.01, 0.01}) region.add(t.rest() + Eigen::Vector2d(x, y));
  }
  region.make_hull();
  t.fit_last_start(planned + Eigen::Vector2d(0.5, 0.3), left, region);
  EXPECT_GE(region.inside_distance(t.last_start()), -1e-12);
}

TEST(IcpTrajectory, SurvivesPhasesOfNoDuration) {
  GaitdGaitState gait = in_swing();
  gait.phase_duration = 0.0;
  for (GaitdFootstep& step : gait.adjusted) step.transfer_duration = step.swing_duration = 0.0;
  const IcpTrajectory t = built(gait);
  const auto s = t.evaluate(0.0);
  EXPECT_TRUE(s.icp.allFinite() && s.icp_velocity.allFinite() && s.ecmp.allFinite());
  EXPECT_TRUE(std::isfinite(t.gamma(0, 0.0)));
}

TEST(IcpTrajectory, HoldsAsManyFootstepsAsTheGaitCanShow) {
  SyntheticWalk walk;
  ASSERT_FALSE(walk.machine.walk({.steps = 40, .length = 0.2}).refused());
  walk.tick();
  ASSERT_EQ(walk.gait().footstep_count, GAITD_MAX_FOOTSTEPS);
  const IcpTrajectory t = built(walk.gait());
  EXPECT_EQ(t.piece_count(), 2 * GAITD_MAX_FOOTSTEPS + 1);
  EXPECT_LE(t.piece_count(), IcpTrajectory::kMaxPieces);
}

}  // namespace
}  // namespace gaitd::walking
