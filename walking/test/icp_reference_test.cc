// SPDX-License-Identifier: Apache-2.0
// The ICP reference never jumps, whatever happens to the plan (theory section 2):
// |xi_ref(t + dt) - xi_ref(t) - xi_ref' dt| <= 1 mm.
#include "gaitd/walking/icp_reference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "walking/test/command_storm.h"
#include "walking/test/synthetic_walk.h"

namespace gaitd::walking {
namespace {

using testing::atlas;
using testing::CommandStorm;
using testing::footstep;
using testing::SyntheticWalk;

constexpr double kLargestJump = 1e-3;  // m

// A walk whose plan is watched at every tick.
class WatchedWalk : public SyntheticWalk {
 public:
  WatchedWalk() {
    const Planner inner = planner;
    planner = [this, inner](const GaitdRobotState& r, const GaitdGaitState& g, GaitdIcpPlan& p) {
      inner(r, g, p);
      const Eigen::Vector2d icp = sdk::view(p.icp);
      if (count_++ > 0) {
        worst = std::max(worst, (icp - predicted_).norm());
        const Eigen::Vector2d mismatch = Eigen::Vector2d(sdk::view(p.icp_velocity)) -
                                         g.omega * (icp - Eigen::Vector2d(sdk::view(p.ecmp)));
        worst_dynamics = std::max(worst_dynamics, mismatch.norm());
      }
      largest_offset = std::max(largest_offset, Eigen::Vector2d(sdk::view(p.offset)).norm());
      predicted_ = icp + dt * Eigen::Vector2d(sdk::view(p.icp_velocity));
    };
  }
  double worst = 0.0;           // m
  double worst_dynamics = 0.0;  // m/s
  double largest_offset = 0.0;  // m

 private:
  Eigen::Vector2d predicted_ = Eigen::Vector2d::Zero();
  int count_ = 0;
};

void walk_on(WatchedWalk& w, double length = 0.35) {
  ASSERT_FALSE(w.machine.walk({.steps = 6, .length = length}).refused());
  ASSERT_TRUE(w.run_until_fraction(2, 0.4));
}

void finish(WatchedWalk& w) {
  EXPECT_TRUE(w.run_until_stand());
  w.run_for(0.5);
  EXPECT_LT(w.worst, kLargestJump);
  EXPECT_LT(w.worst_dynamics, 1e-9);
  EXPECT_GT(w.ticks, 2000);
}

TEST(IcpReference, IsSmoothWhileNothingHappens) {
  WatchedWalk w;
  walk_on(w);
  finish(w);
  EXPECT_LT(w.worst, 1e-5);
}

TEST(IcpReference, StaysWhereItIsWhenParametersMoveThePlan) {
  for (const double fraction : {0.1, 0.5, 0.9}) {
    WatchedWalk w;
    walk_on(w);
    ASSERT_TRUE(w.run_until_fraction(3, fraction));
    w.offsets.exit_x = 0.1;
    w.offsets.entry_y = 0.3;
    w.machine.plan_anew();
    finish(w);
    EXPECT_GT(w.largest_offset, 5e-3);
  }
}

TEST(IcpReference, StartsWhereTheRobotRestsAndReachesTheMiddleOfTheFeetByWalking) {
  SyntheticWalk w;
  w.robot.com[0] += 0.03;
  w.planner(w.robot, w.gait(), w.plan);
  EXPECT_NEAR(w.plan.icp[0], w.robot.com[0], 1e-12);
  EXPECT_NEAR(w.plan.icp_velocity[0], 0.0, 1e-12);
  ASSERT_FALSE(w.machine.walk({.steps = 3, .length = 0.2}).refused());
  w.tick();
  ASSERT_TRUE(w.run_until_stand());
  w.run_for(1.0);
  EXPECT_NEAR(w.plan.icp[0], 0.6, 2e-3);
  EXPECT_LT(std::abs(w.plan.icp_velocity[0]), 1e-9);
}

TEST(IcpReference, DoesNotJumpWhenFootstepsAreQueued) {
  WatchedWalk w;
  ASSERT_FALSE(w.machine.walk({.steps = 1, .length = 0.35}).refused());
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_SWING, 2));
  w.run_for(0.4);
  ASSERT_FALSE(w.machine.walk({.steps = 4, .length = 0.35}).refused());
  finish(w);
  EXPECT_GT(w.largest_offset, 0.003);  // the plan did change
}

TEST(IcpReference, DoesNotJumpWhenFootstepsAreReplaced) {
  WatchedWalk w;
  walk_on(w);
  const GaitdGaitState& g = w.gait();
  const int side = g.support;
  const GaitdPose& swing = g.adjusted[0].pose;
  const double y = swing.position[1] + (side == GAITD_LEFT ? 0.3 : -0.3);
  const GaitdFootstep steps[] = {footstep(side, swing.position[0] - 0.1, y)};
  ASSERT_FALSE(w.machine.footsteps(steps, 1, true).refused());
  finish(w);
  EXPECT_GT(w.largest_offset, 0.01);
}

TEST(IcpReference, DoesNotJumpWhenTheNextFootstepIsMoved) {
  WatchedWalk w;
  walk_on(w);
  w.adjustment.active = 1;
  w.adjustment.shift[0] = 0.10;
  w.adjustment.shift[1] = 0.05;
  w.run_for(0.1);
  w.adjustment = {};
  finish(w);
  EXPECT_GT(w.largest_offset, 0.01);
}

TEST(IcpReference, DoesNotJumpWhenTheSwingIsRetimed) {
  for (double shift : {-0.15, 0.2}) {
    WatchedWalk w;
    walk_on(w);
    w.adjustment.active = 1;
    w.adjustment.time_shift = shift;
    w.tick();
    w.adjustment = {};
    finish(w);
    EXPECT_GT(w.largest_offset, 0.01);
  }
}

TEST(IcpReference, DoesNotJumpAtEarlyTouchdowns) {
  WatchedWalk w;
  w.landing_delay = -0.12;
  walk_on(w);
  finish(w);
  EXPECT_GT(w.largest_offset, 0.01);
}

TEST(IcpReference, DoesNotJumpAtLateTouchdowns) {
  for (double length : {0.35, 0.7}) {
    for (double delay : {0.03, 0.08, 0.3}) {
      WatchedWalk w;
      w.landing_delay = delay;
      walk_on(w, length);
      finish(w);
    }
  }
}

TEST(IcpReference, DoesNotJumpWhenATransferWaitsForTheRobot) {
  for (double length : {0.35, 0.7}) {
    WatchedWalk w;
    w.icp_error = 0.08;  // forces the whole patience of every transfer
    walk_on(w, length);
    finish(w);
  }
}

TEST(IcpReference, DoesNotJumpWhenPausedAndResumed) {
  WatchedWalk w;
  walk_on(w);
  ASSERT_FALSE(w.machine.pause().refused());
  w.run_for(0.5);  // into the final transfer
  ASSERT_FALSE(w.machine.resume().refused());
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_SWING, 4));
  ASSERT_FALSE(w.machine.pause().refused());
  ASSERT_TRUE(w.run_until_stand());
  ASSERT_FALSE(w.machine.resume().refused());
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_SWING, 5));
  finish(w);
}

// The ICP is where it would be if the walk went on. What the last transfer cannot make of that, an
// offset makes, and the CMP of an offset may lie beside the foot.
TEST(IcpReference, AWalkThatEndsEarlyKeepsItsCmpInTheFoot) {
  for (const double length : {0.3, 0.5}) {
    for (const double fraction : {0.1, 0.4, 0.7}) {
      WatchedWalk w;
      walk_on(w, length);
      ASSERT_TRUE(w.run_until_fraction(3, fraction));
      ASSERT_FALSE(w.machine.pause().refused());
      double outside = 0.0;
      w.on_update = [&] {
        if (w.gait().phase != GAITD_PHASE_SWING) return;
        const GaitdFoothold& stance = w.gait().footholds[w.gait().support];
        ConvexPolygon sole;
        add_foothold(stance, atlas().feet[w.gait().support].toe_point, sole);
        sole.make_hull();
        outside = std::max(outside, -sole.inside_distance(sdk::view(w.plan.ecmp)));
      };
      ASSERT_TRUE(w.run_until_stand());
      EXPECT_LT(outside, 0.02) << length << " m, paused after " << fraction << " of a swing";
    }
  }
}

TEST(IcpReference, DoesNotJumpWhenStoppedOrAborted) {
  for (double fraction : {0.1, 0.5, 0.9}) {
    WatchedWalk stopped;
    walk_on(stopped);
    ASSERT_TRUE(stopped.run_until_fraction(3, fraction));
    ASSERT_FALSE(stopped.machine.stop().refused());
    finish(stopped);
    WatchedWalk aborted;
    walk_on(aborted);
    ASSERT_TRUE(aborted.run_until_fraction(3, fraction));
    ASSERT_FALSE(aborted.machine.abort().refused());
    finish(aborted);
  }
}

TEST(IcpReference, DoesNotJumpWhenFootholdsLieHigherOrLowerThanTheyShould) {
  for (double error : {-0.03, 0.03}) {
    WatchedWalk w;
    w.ground_error = error;
    walk_on(w);
    finish(w);
  }
}

TEST(IcpReference, DoesNotJumpInRandomSequencesOfCommands) {
  double largest_offset = 0.0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    WatchedWalk w;
    CommandStorm storm(seed);
    for (int i = 0; i < 15000; ++i) {
      storm.disturb(w);
      w.tick();
    }
    EXPECT_LT(w.worst, kLargestJump) << "seed " << seed;
    EXPECT_GT(storm.accepted(), 10) << "seed " << seed;
    largest_offset = std::max(largest_offset, w.largest_offset);
  }
  EXPECT_GT(largest_offset, 0.02);
}

TEST(IcpReference, AnotherInstanceContinuesFromItsState) {
  SyntheticWalk w;
  IcpReference a(atlas());
  IcpReference b(atlas());
  bool handed_over = false;
  double difference = 0.0;
  w.planner = [&](const GaitdRobotState& r, const GaitdGaitState& g, GaitdIcpPlan& p) {
    a.update(w.dt, r, g, CmpOffsets(atlas().nominal_com_height), p);
    if (!handed_over) return;
    GaitdIcpPlan other{};
    b.update(w.dt, r, g, CmpOffsets(atlas().nominal_com_height), other);
    difference = std::max(
        difference,
        (Eigen::Vector2d(sdk::view(p.icp)) - Eigen::Vector2d(sdk::view(other.icp))).norm());
  };
  ASSERT_FALSE(w.machine.walk({.steps = 4, .length = 0.3}).refused());
  w.run_for(0.3);  // in the first transfer, whose start was fitted
  GaitdIcpPlannerState state{};
  a.get_state(state);
  b.set_state(state);
  handed_over = true;
  ASSERT_TRUE(w.run_until_stand());
  EXPECT_LT(difference, 1e-5);
}

// Late in a swing, another plan of the foot is no reason to put it elsewhere.
TEST(IcpReference, AnotherPlanExpectsAtTouchdownWhatIsOnItsWay) {
  SyntheticWalk w;
  IcpReference a(atlas());
  IcpReference b(atlas());
  CmpOffsets middle(atlas().nominal_com_height);
  middle.entry_x = middle.exit_x = 0.0;
  GaitdIcpPlan before{}, after{};
  w.planner = [&](const GaitdRobotState& r, const GaitdGaitState& g, GaitdIcpPlan& p) {
    a.update(w.dt, r, g, CmpOffsets(atlas().nominal_com_height), p);
    before = p;
    if (after.size != 0) b.update(w.dt, r, g, middle, after);
  };
  ASSERT_FALSE(w.machine.walk({.steps = 6, .length = 0.4}).refused());
  ASSERT_TRUE(w.run_until_fraction(3, 0.9));
  const Eigen::Vector2d own = sdk::view(before.icp_touchdown);
  GaitdIcpPlannerState state{};
  a.get_state(state);
  b.set_state(state);
  after.size = sizeof(after);
  w.run_for(2 * w.dt);
  const double moved = (Eigen::Vector2d(sdk::view(after.icp_touchdown)) - own).norm();
  const double planned = (Eigen::Vector2d(sdk::view(after.offset))).norm();
  EXPECT_GT(planned, 0.03);  // another plan
  EXPECT_LT(moved, 0.5 * planned);
  ASSERT_TRUE(w.run_until_fraction(4, 0.5));
  // In the next step it has its own way.
  IcpReference c(atlas());
  GaitdIcpPlan alone{};
  c.update(w.dt, w.robot, w.gait(), middle, alone);
  EXPECT_LT((Eigen::Vector2d(sdk::view(after.icp_touchdown)) -
             Eigen::Vector2d(sdk::view(alone.icp_touchdown)))
                .norm(),
            1e-9);
}

TEST(IcpReference, ReportsGammaForTheFootstepsAheadOnly) {
  SyntheticWalk w;
  ASSERT_FALSE(w.machine.walk({.steps = 3, .length = 0.4}).refused());
  ASSERT_TRUE(w.run_until_fraction(1, 0.5));
  const int ahead = w.gait().footstep_count;
  ASSERT_EQ(ahead, 4);
  for (int i = 0; i < GAITD_MAX_FOOTSTEPS; ++i) {
    if (i < ahead) {
      EXPECT_GT(w.plan.gamma[i], 0.0) << i;
    } else {
      EXPECT_EQ(w.plan.gamma[i], 0.0) << i;
    }
  }
}

}  // namespace
}  // namespace gaitd::walking
