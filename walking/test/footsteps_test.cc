// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/footsteps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "gaitd/walking/support.h"
#include "walking/test/synthetic_walk.h"

namespace gaitd::walking {
namespace {

using testing::atlas;
using testing::footstep;
using testing::SyntheticWalk;

const StepLimits& limits() {
  static const StepLimits limits = GaitMachine(atlas()).limits();
  return limits;
}

GaitdPose pose(double x, double y, double yaw) {
  GaitdPose p{};
  p.position[0] = x;
  p.position[1] = y;
  sdk::store(sdk::from_yaw(yaw), p.orientation);
  return p;
}

// start * N x (length, lateral, turn), by homogeneous transforms.
Eigen::Isometry2d after(const GaitdPose& start, const WalkCommand& walk) {
  Eigen::Isometry2d at = Eigen::Isometry2d::Identity();
  at.translate(Eigen::Vector2d(start.position[0], start.position[1]));
  at.rotate(sdk::yaw_of(sdk::quaternion(start.orientation)));
  for (int i = 0; i < walk.steps; ++i) {
    at.translate(Eigen::Vector2d(walk.length, walk.lateral));
    at.rotate(walk.turn);
  }
  return at;
}

struct Named {
  const char* name;
  WalkCommand walk;
};
const Named kWalks[] = {
    {"forward", {.steps = 7, .length = 0.35}},
    {"backward", {.steps = 5, .length = -0.2}},
    {"left", {.steps = 6, .lateral = 0.15, .first_side = GAITD_LEFT}},
    {"right", {.steps = 6, .lateral = -0.15, .first_side = GAITD_RIGHT}},
    {"turning", {.steps = 8, .turn = 0.3}},
    {"curve", {.steps = 9, .length = 0.3, .turn = -0.15}},
    {"everything", {.steps = 5, .length = 0.25, .lateral = 0.05, .turn = 0.1}},
    {"on the spot", {.steps = 4}},
};

TEST(FootstepGenerator, TheFeetEndWhereTheMovesOfAllStepsLead) {
  for (const Named& n : kWalks) {
    const GaitdPose start = pose(1.0, -2.0, 0.7);
    FootstepGenerator generator(n.walk, start, GAITD_LEFT, 0.25, limits().least_separation);
    ASSERT_EQ(generator.count(), n.walk.steps + 1) << n.name;
    GaitdPose feet[2];
    for (int i = 0; i < generator.count(); ++i) {
      const GaitdFootstep step = generator.next();
      feet[step.side] = step.pose;
      EXPECT_EQ(step.closing, i == n.walk.steps ? 1 : 0) << n.name;
    }
    const GaitdPose middle = middle_pose(feet[GAITD_LEFT], feet[GAITD_RIGHT]);
    const Eigen::Isometry2d expected = after(start, n.walk);
    EXPECT_NEAR(middle.position[0], expected.translation().x(), 1e-9) << n.name;
    EXPECT_NEAR(middle.position[1], expected.translation().y(), 1e-9) << n.name;
    const double yaw = sdk::yaw_of(sdk::quaternion(middle.orientation));
    const double expected_yaw = Eigen::Rotation2Dd(expected.linear()).angle();
    EXPECT_NEAR(std::remainder(yaw - expected_yaw, 2 * M_PI), 0.0, 1e-9) << n.name;
  }
}

TEST(FootstepGenerator, TheRobotThatWalksThemEndsThereToo) {
  for (const Named& n : kWalks) {
    SyntheticWalk w;
    const GaitdPose start =
        middle_pose(w.gait().footholds[GAITD_LEFT].pose, w.gait().footholds[GAITD_RIGHT].pose);
    const Refusal refusal = w.machine.walk(n.walk);
    ASSERT_FALSE(refusal.refused()) << n.name << ": " << refusal.message;
    w.tick();
    ASSERT_TRUE(w.run_until_stand()) << n.name;
    const GaitdPose end =
        middle_pose(w.gait().footholds[GAITD_LEFT].pose, w.gait().footholds[GAITD_RIGHT].pose);
    const Eigen::Isometry2d expected = after(start, n.walk);
    EXPECT_NEAR(end.position[0], expected.translation().x(), 1e-6) << n.name;
    EXPECT_NEAR(end.position[1], expected.translation().y(), 1e-6) << n.name;
    EXPECT_EQ(w.gait().step_index, n.walk.steps + 1);
  }
}

TEST(FootstepGenerator, SidesAlternateFromTheFirst) {
  for (int first : {GAITD_LEFT, GAITD_RIGHT}) {
    FootstepGenerator generator({.steps = 5, .length = 0.3}, pose(0, 0, 0), first, 0.25,
                                limits().least_separation);
    int expected = first;
    for (int i = 0; i < generator.count(); ++i) {
      const GaitdFootstep step = generator.next();
      EXPECT_EQ(step.side, expected);
      EXPECT_EQ(side_sign(step.side) * step.pose.position[1] > 0.0, true);
      expected = other_side(expected);
    }
  }
}

TEST(FootstepGenerator, TheWidthIsTheDistanceOfTheSoles) {
  FootstepGenerator generator({.steps = 4, .length = 0.3}, pose(0, 0, 0), GAITD_LEFT, 0.31,
                              limits().least_separation);
  double last = -0.155;
  for (int i = 0; i < generator.count(); ++i) {
    const double y = generator.next().pose.position[1];
    EXPECT_NEAR(std::abs(y - last), 0.31, 1e-12);
    last = y;
  }
}

// Distance of a footstep from its stance foot, outwards in the frame of the stance foot.
double separation(const GaitdPose& stance, const GaitdFootstep& step) {
  const Eigen::Vector3d d = sdk::quaternion(stance.orientation).conjugate() *
                            (sdk::view(step.pose.position) - sdk::view(stance.position));
  return side_sign(step.side) * d.y();
}

TEST(FootstepGenerator, TheLeastSeparationIsARealOne) {
  EXPECT_GT(limits().least_separation, 0.1);
  EXPECT_LT(limits().least_separation, atlas().nominal_foot_separation);
}

TEST(FootstepGenerator, SidewaysWalksNeverBringTheFeetCloserThanAllowed) {
  for (double lateral = -0.3; lateral <= 0.3; lateral += 0.05) {
    for (int first : {GAITD_LEFT, GAITD_RIGHT}) {
      const WalkCommand walk{.steps = 5, .lateral = lateral};
      FootstepGenerator generator(walk, pose(0, 0, 0), first, 0.2264, limits().least_separation);
      GaitdPose stance{};
      for (int i = 0; i < generator.count(); ++i) {
        const GaitdFootstep step = generator.next();
        // The first is taken from where the feet stand, not from a generated footstep.
        if (i > 0) {
          EXPECT_GE(separation(stance, step), limits().least_separation - 1e-9) << lateral;
        }
        stance = step.pose;
      }
    }
  }
}

TEST(FootstepGenerator, ASingleStepSidewaysIsAsWideAsItWasAskedFor) {
  const WalkCommand walk{.steps = 1, .lateral = 0.6};
  FootstepGenerator generator(walk, pose(0, 0, 0), GAITD_LEFT, 0.22, limits().least_separation);
  EXPECT_NEAR(generator.next().pose.position[1], 0.6 + 0.11, 1e-12);
  EXPECT_NEAR(generator.next().pose.position[1], 0.6 - 0.11, 1e-12);
}

TEST(FootstepGenerator, WhatAMachineAcceptsNeverBringsTheFeetTooClose) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int accepted = 0;
  for (int run = 0; run < 500; ++run) {
    SyntheticWalk w;
    const WalkCommand walk{.steps = 6,
                           .length = 0.5 * uniform(random),
                           .lateral = 0.3 * uniform(random),
                           .width = 0.25 + 0.1 * uniform(random),
                           .turn = 0.5 * uniform(random)};
    if (w.machine.walk(walk).refused()) continue;
    ++accepted;
    w.tick();
    const GaitdGaitState& g = w.gait();
    GaitdPose stance = g.footholds[other_side(g.commanded[0].side)].pose;
    for (int i = 0; i < g.footstep_count; ++i) {
      // Half a centimetre is what check_footstep() forgives.
      EXPECT_GE(separation(stance, g.commanded[i]), limits().least_separation - 0.005 - 1e-9);
      stance = g.commanded[i].pose;
    }
  }
  EXPECT_GT(accepted, 50);
  EXPECT_LT(accepted, 450);
}

TEST(Straddle, ALongStepLeavesLittleTimeForItsTransfer) {
  const double separation = atlas().nominal_foot_separation;
  const auto refused = [&](double length, double transfer) {
    GaitdFootstep step = footstep(GAITD_RIGHT, 0.0, 0.0);
    step.transfer_duration = transfer;
    const GaitdPose stance = pose(length, separation, 0.0), from = pose(0.0, 0.0, 0.0);
    return check_straddle(step, stance, from, 1, limits()).refused();
  };
  EXPECT_FALSE(refused(0.78, 5.0)) << "stands there as well as with its feet side by side";
  EXPECT_FALSE(refused(-0.78, 5.0));
  EXPECT_TRUE(refused(0.82, 0.65));
  EXPECT_TRUE(refused(-0.82, 0.65));
  EXPECT_FALSE(refused(0.82, 0.6));
  EXPECT_FALSE(refused(1.0, 0.6));
  EXPECT_TRUE(refused(1.0, 0.65));
}

TEST(Stride, AFootIsAsFastAsBalanceAllows) {
  const double separation = atlas().nominal_foot_separation;
  const auto refused = [&](double length, double start, double swing) {
    GaitdFootstep step = footstep(GAITD_RIGHT, length, -separation);
    step.swing_duration = swing;
    const GaitdPose stance = pose(0.0, 0.0, 0.0), from = pose(start, -separation, 0.0);
    return check_stride(step, stance, from, 1, limits()).refused();
  };
  // 2.8 m/s: the speed of 0.825 of the pendulum.
  EXPECT_TRUE(refused(0.7, -0.7, 0.49));
  EXPECT_FALSE(refused(0.7, -0.7, 0.5));
  EXPECT_TRUE(refused(0.5, -0.5, 0.35));
  EXPECT_FALSE(refused(0.5, -0.5, 0.36));
  EXPECT_TRUE(refused(0.78, -0.78, 0.5));
  EXPECT_FALSE(refused(0.78, -0.78, 0.56));
  EXPECT_TRUE(refused(0.9, -0.9, 0.5));
  EXPECT_TRUE(refused(-0.9, 0.9, 0.5));
  EXPECT_FALSE(refused(0.9, -0.9, 0.7));
  EXPECT_FALSE(refused(0.9, 0.0, 0.4)) << "out of standing a foot has half the way to go";
}

// The same fraction of the reach ahead and aside: 0.7 of both is in reach, 0.72 is not.
TEST(Reach, ALegThatReachesAheadOrAsideDoesNotReachBothAtOnce) {
  const StepLimits& most = limits();
  const double aside = most.largest_separation - most.nominal_separation;
  const auto refused = [&](double ahead, double share) {
    GaitdFootstep step{};
    step.side = GAITD_LEFT;
    step.pose = pose(ahead, most.nominal_separation + share * aside, 0.0);
    const GaitdPose from = pose(0.0, most.nominal_separation, 0.0);
    return check_footstep(step, pose(0.0, 0.0, 0.0), from, 1, most).refused();
  };
  for (const double reach : {most.forward, -most.backward}) {
    EXPECT_FALSE(refused(reach, 0.0)) << reach;
    EXPECT_FALSE(refused(0.7 * reach, 0.7)) << reach;
    EXPECT_TRUE(refused(0.72 * reach, 0.72)) << reach;
    EXPECT_TRUE(refused(reach, 1.0)) << reach;
  }
  EXPECT_FALSE(refused(0.0, 1.0));
}

TEST(MiddlePose, LiesHalfWayAndTurnsTheShortWayRound) {
  GaitdPose a = pose(1.0, 2.0, 3.0);
  GaitdPose b = pose(3.0, 0.0, -3.0);
  b.position[2] = 0.2;
  const GaitdPose m = middle_pose(a, b);
  EXPECT_NEAR(m.position[0], 2.0, 1e-12);
  EXPECT_NEAR(m.position[1], 1.0, 1e-12);
  EXPECT_NEAR(m.position[2], 0.1, 1e-12);
  EXPECT_NEAR(std::abs(sdk::yaw_of(sdk::quaternion(m.orientation))), M_PI, 1e-9);
}

TEST(MiddlePose, IsLevelWhateverTheFeetAre) {
  GaitdPose a = pose(0, 0.1, 0);
  GaitdPose b = pose(0, -0.1, 0);
  sdk::store(sdk::from_roll_pitch_yaw(0.2, -0.3, 0.4), a.orientation);
  const Eigen::Vector3d rpy = sdk::roll_pitch_yaw(sdk::quaternion(middle_pose(a, b).orientation));
  EXPECT_NEAR(rpy.x(), 0.0, 1e-12);
  EXPECT_NEAR(rpy.y(), 0.0, 1e-12);
  EXPECT_NEAR(rpy.z(), 0.2, 1e-12);
}

TEST(FootstepQueue, IsFirstInFirstOutAroundTheEndOfItsStorage) {
  FootstepQueue queue(3);
  std::uint32_t pushed = 0;
  std::uint32_t popped = 0;
  for (int round = 0; round < 20; ++round) {
    while (queue.free() > 0) {
      GaitdFootstep step{};
      step.id = pushed++;
      queue.push(step);
    }
    EXPECT_EQ(queue.size(), 3);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(queue[i].id, popped + i);
    queue.pop();
    ++popped;
  }
  queue.truncate(1);
  EXPECT_EQ(queue.size(), 1);
  queue.truncate(5);
  EXPECT_EQ(queue.size(), 1);
}

}  // namespace
}  // namespace gaitd::walking
