// SPDX-License-Identifier: Apache-2.0
#include "gaitd/footsteps/planner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "footsteps/test/fields.h"
#include "gaitd/walking/support.h"

namespace gaitd::footsteps {
namespace {

using testing::atlas;
using testing::cinder_blocks;
using testing::field;
using testing::refusal_of;
using testing::standing_at;
using testing::start_of;
using walking::GaitMachine;

std::unique_ptr<GaitMachine> standing_gait(double x, double y, double yaw, double z = 0.0) {
  auto gait = std::make_unique<GaitMachine>(atlas());
  gait->reset(standing_at(x, y, yaw, z));
  return gait;
}

GaitdPose middle_of(const Plan& plan) {
  const std::size_t n = plan.footsteps.size();
  return walking::middle_pose(plan.footsteps[n - 2].pose, plan.footsteps[n - 1].pose);
}

void expect_at(const GaitdPose& pose, const Goal& goal, double tolerance) {
  EXPECT_LT(std::hypot(pose.position[0] - goal.x, pose.position[1] - goal.y), tolerance);
  if (!goal.yaw) return;
  const double yaw = sdk::yaw_of(sdk::quaternion(pose.orientation));
  EXPECT_NEAR(std::remainder(yaw - *goal.yaw, 2 * M_PI), 0.0, 1e-6);
}

// Every sole lies on the ground that is there, but for what a cell of the map may hide at its rim.
void expect_on(const terrain::HeightMap& map, const Plan& plan) {
  for (const GaitdFootstep& step : plan.footsteps) {
    const GaitdFoot& foot = atlas().feet[step.side];
    for (int i = 0; i < foot.point_count; ++i) {
      const Eigen::Vector3d p =
          sdk::transform(step.pose, {0.85 * foot.points[i][0], 0.75 * foot.points[i][1], 0.0});
      const auto surface = map.surface(p.head<2>());
      ASSERT_TRUE(surface) << p.transpose();
      EXPECT_NEAR(surface->height, p.z(), 0.02) << p.transpose();
    }
  }
}

TEST(TurnWalkTurn, EveryPlaceOnLevelGroundIsReachedAndTheGaitMachineAgrees) {
  const auto planner = make_planner("turn_walk_turn", atlas(), nullptr);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-3, 3), yaw(-M_PI, M_PI);
  for (int k = 0; k < 60; ++k) {
    const auto gait = standing_gait(place(random), place(random), yaw(random), 0.4);
    Goal goal{place(random), place(random), yaw(random)};
    if (k % 3 == 0) goal.yaw.reset();
    if (k % 4 == 0) {  // nearby
      goal.x = gait->state().footholds[0].pose.position[0] + 0.1 * place(random);
      goal.y = gait->state().footholds[0].pose.position[1] + 0.1 * place(random);
    }
    const Plan plan = planner->plan(start_of(*gait), goal, gait->parameters());
    ASSERT_EQ(plan.refusal, "") << k;
    ASSERT_GE(plan.footsteps.size(), 2u);
    EXPECT_EQ(refusal_of(gait.get(), plan), "") << k;
    expect_at(middle_of(plan), goal, 1e-6);
    for (const GaitdFootstep& step : plan.footsteps) EXPECT_NEAR(step.pose.position[2], 0.4, 1e-9);
  }
}

TEST(TurnWalkTurn, ItWalksTheShorterWay) {
  const auto planner = make_planner("turn_walk_turn", atlas(), nullptr);
  const auto gait = standing_gait(0, 0, 0);
  const auto steps_to = [&](const Goal& goal) {
    return planner->plan(start_of(*gait), goal, gait->parameters()).footsteps;
  };
  // A little way back or aside, looking ahead: nobody turns round for it.
  for (const Goal& goal : {Goal{-0.3, 0.0, 0.0}, Goal{0.0, 0.25, 0.0}, Goal{0.0, -0.25, 0.0}}) {
    for (const GaitdFootstep& step : steps_to(goal)) {
      EXPECT_NEAR(sdk::yaw_of(sdk::quaternion(step.pose.orientation)), 0.0, 1e-9);
    }
  }
  EXPECT_LT(steps_to({0.0, 3.0, {}}).size(), 20u) << "it walks ahead";
}

TEST(TurnWalkTurn, StandingThereIsNoWork) {
  const auto planner = make_planner("auto", atlas(), nullptr);
  const auto gait = standing_gait(1, 2, 0.5);
  const Plan plan = planner->plan(start_of(*gait), {1, 2, 0.5}, gait->parameters());
  EXPECT_EQ(plan.refusal, "");
  EXPECT_TRUE(plan.footsteps.empty());
}

TEST(TurnWalkTurn, ItSaysWhatIsInTheWay) {
  const auto map = field({-1, -1}, {4, 1}, [](double x, double) { return x > 2 ? 0.1 : 0.0; });
  const auto planner = make_planner("turn_walk_turn", atlas(), map);
  const auto gait = standing_gait(0, 0, 0);
  const Plan plan = planner->plan(start_of(*gait), {3, 0, 0}, gait->parameters());
  EXPECT_TRUE(plan.footsteps.empty());
  EXPECT_NE(plan.refusal.find("no way straight to the goal: footstep"), std::string::npos)
      << plan.refusal;
}

TEST(Lattice, ItCrossesTheCinderBlocksAndTheGaitMachineAgrees) {
  const auto map = cinder_blocks();
  const auto planner = make_planner("lattice", atlas(), map);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> side(-0.12, 0.12), yaw(-0.3, 0.3);
  for (int k = 0; k < 20; ++k) {
    const bool tilted = k % 2 == 1;
    const auto gait = standing_gait(tilted ? 4.4 : -0.5, 0.3 * side(random), yaw(random));
    const Goal goal{tilted ? 8.8 : 4.41, side(random), 0.3 * yaw(random)};
    const Plan plan = planner->plan(start_of(*gait), goal, gait->parameters());
    ASSERT_EQ(plan.refusal, "") << k;
    EXPECT_EQ(refusal_of(gait.get(), plan), "") << k;
    expect_at(middle_of(plan), goal, 0.16);
    expect_on(*map, plan);
    EXPECT_LT(plan.expansions, 15000);
  }
}

TEST(Lattice, TheSameProblemHasTheSameAnswerToTheBit) {
  const auto map = cinder_blocks();
  const auto gait = standing_gait(4.4, 0, 0);
  const Goal goal{8.8, 0.1, 0.2};
  const auto one = make_planner("lattice", atlas(), map);
  const Plan a = one->plan(start_of(*gait), goal, gait->parameters());
  one->plan(start_of(*gait), {6.0, 0.0, 0.0}, gait->parameters());
  const Plan b = one->plan(start_of(*gait), goal, gait->parameters());
  const Plan c =
      make_planner("lattice", atlas(), map)->plan(start_of(*gait), goal, gait->parameters());
  ASSERT_FALSE(a.footsteps.empty());
  for (const Plan* other : {&b, &c}) {
    ASSERT_EQ(other->footsteps.size(), a.footsteps.size());
    EXPECT_EQ(other->expansions, a.expansions);
    for (std::size_t i = 0; i < a.footsteps.size(); ++i) {
      const GaitdPose &one = other->footsteps[i].pose, &two = a.footsteps[i].pose;
      EXPECT_TRUE(std::ranges::equal(one.position, two.position));
      EXPECT_TRUE(std::ranges::equal(one.orientation, two.orientation));
      EXPECT_EQ(other->footsteps[i].transfer_duration, a.footsteps[i].transfer_duration);
    }
  }
}

TEST(Lattice, AWallIsWalkedAround) {
  const auto map = field({-1, -2}, {4, 2}, [](double x, double y) {
    return std::abs(x - 1.5) < 0.1 && y < 0.3 ? 1.5 : 0.0;
  });
  const auto planner = make_planner("lattice", atlas(), map);
  const auto gait = standing_gait(0, 0, 0);
  const Plan plan = planner->plan(start_of(*gait), {3, 0, 0}, gait->parameters());
  ASSERT_EQ(plan.refusal, "");
  EXPECT_EQ(refusal_of(gait.get(), plan), "");
  expect_on(*map, plan);
  double furthest = 0.0;
  for (const GaitdFootstep& step : plan.footsteps) {
    furthest = std::max(furthest, step.pose.position[1]);
  }
  EXPECT_GT(furthest, 0.75) << "the arms do not pass at less than their reach";
}

// A wall that is as wide as far, with sides: the straight way ends in it.
double dead_end(double x, double y) {
  const bool back = std::abs(x - 2.5) < 0.1 && std::abs(y) < 1.6;
  const bool sides = x > 0.6 && x < 2.6 && std::abs(std::abs(y) - 1.5) < 0.1;
  return back || sides ? 1.0 : 0.0;
}

TEST(Lattice, ADeadEndIsLeft) {
  const auto map = field({-2, -4}, {5, 4}, dead_end);
  const auto planner = make_planner("lattice", atlas(), map);
  const auto gait = standing_gait(1.0, 0, 0);
  const Plan plan = planner->plan(start_of(*gait), {4, 0, 0}, gait->parameters());
  ASSERT_EQ(plan.refusal, "");
  EXPECT_EQ(refusal_of(gait.get(), plan), "");
  expect_on(*map, plan);
  expect_at(middle_of(plan), {4, 0, 0}, 1e-6);
}

TEST(Lattice, WhereTheMapEndsTheRobotLooksOn) {
  // Around the robot a metre is known; the goal is behind it.
  const auto map = field({-3, -3}, {3, 3},
                         [](double x, double y) { return std::hypot(x, y) < 1.0 ? 0.0 : NAN; });
  const auto planner = make_planner("lattice", atlas(), map, {.explore = true});
  const auto gait = standing_gait(0, 0, 0);
  const Plan plan = planner->plan(start_of(*gait), {-2.5, 0, {}}, gait->parameters());
  ASSERT_EQ(plan.refusal, "");
  EXPECT_TRUE(plan.partial);
  const double yaw = sdk::yaw_of(sdk::quaternion(plan.footsteps.back().pose.orientation));
  EXPECT_LT(std::abs(std::remainder(yaw - M_PI, 2.0 * M_PI)), 1.1);
}

TEST(Lattice, AGapIsSteppedOverAndABarHasTheSwingGoHigher) {
  const auto gap = field({-1, -0.5}, {3, 0.5},
                         [](double x, double) { return std::abs(x - 1.0) < 0.1 ? -2.0 : 0.0; });
  const auto bar = field({-1, -0.5}, {3, 0.5},
                         [](double x, double) { return std::abs(x - 1.0) < 0.05 ? 0.15 : 0.0; });
  for (const auto& map : {gap, bar}) {
    const auto planner = make_planner("lattice", atlas(), map);
    const auto gait = standing_gait(0, 0, 0);
    const Plan plan = planner->plan(start_of(*gait), {2, 0, 0}, gait->parameters());
    ASSERT_EQ(plan.refusal, "");
    EXPECT_EQ(refusal_of(gait.get(), plan), "");
    expect_on(*map, plan);
    double highest = 0.0;
    for (const GaitdFootstep& step : plan.footsteps) {
      highest = std::max(highest, step.swing_height);
    }
    if (map == bar) {
      EXPECT_GT(highest, 0.17);
    } else {
      EXPECT_EQ(highest, gait->parameters()[walking::Gait::kSwingHeight]);
    }
  }
}

// Where one cannot go, and what is said of it.
std::string no_way(const std::function<double(double x, double y)>& height, const Goal& goal,
                   int expansions = 3000) {
  const auto planner =
      make_planner("lattice", atlas(), field({-1, -1}, {4, 1}, height), {expansions});
  const auto gait = standing_gait(0, 0, 0);
  const Plan plan = planner->plan(start_of(*gait), goal, gait->parameters());
  EXPECT_TRUE(plan.footsteps.empty());
  return plan.refusal;
}

TEST(Lattice, ItSaysWhyThereIsNoWay) {
  const auto level = [](double, double) { return 0.0; };
  EXPECT_NE(no_way(level, {9, 0, 0}).find("goal (9.00, 0.00): the ground there is not known"),
            std::string::npos);
  const auto cliff = [](double x, double) { return x < 1.5 ? 0.0 : -0.6; };
  const std::string down = no_way(cliff, {3, 0, 0});
  EXPECT_NE(down.find(" to (3.00, 0.00): footsteps get as far as (1."), std::string::npos) << down;
  EXPECT_NE(down.find("steps out of reach"), std::string::npos) << down;
  const auto rubble = [](double x, double y) {
    return std::abs(x - 2.0) < 0.8 ? 0.03 * std::sin(50 * x) * std::sin(45 * y) : 0.0;
  };
  const std::string rough = no_way(rubble, {3.5, 0, 0});
  EXPECT_NE(rough.find("not flat enough"), std::string::npos) << rough;
  const auto unknown = [](double x, double) { return std::abs(x - 2.0) < 0.8 ? NAN : 0.0; };
  const std::string blind = no_way(unknown, {3.5, 0, 0});
  EXPECT_NE(blind.find("not known"), std::string::npos) << blind;
  const std::string short_search = no_way(cliff, {3, 0, 0}, 100);
  EXPECT_NE(short_search.find("no way found in 100 expansions (goto.expansions)"),
            std::string::npos)
      << short_search;
}

TEST(Lattice, WithoutAMapTheGroundIsAsHighAsTheFeet) {
  const auto planner = make_planner("lattice", atlas(), nullptr);
  const auto gait = standing_gait(0, 0, 0, 0.4);
  const Plan plan = planner->plan(start_of(*gait), {1, 0, 0}, gait->parameters());
  ASSERT_EQ(plan.refusal, "");
  EXPECT_EQ(refusal_of(gait.get(), plan), "");
  expect_at(middle_of(plan), {1, 0, 0}, 1e-6);
  for (const GaitdFootstep& step : plan.footsteps) EXPECT_NEAR(step.pose.position[2], 0.4, 1e-9);
}

// Of a goal where one foot would stand on rubble and the other where nothing is known.
TEST(Lattice, AGoalOnUnknownGroundIsOneWhicheverFootItIsOf) {
  for (const double side : {1.0, -1.0}) {
    const auto map = field({-1, -1}, {4, 1}, [side](double x, double y) {
      if (x < 2.0) return 0.0;
      return side * y > 0.0 ? NAN : 0.03 * std::sin(50 * x) * std::sin(45 * y);
    });
    const auto planner = make_planner("lattice", atlas(), map, {.explore = true});
    const auto gait = standing_gait(0, 0, 0);
    const Plan plan = planner->plan(start_of(*gait), {3, 0, 0}, gait->parameters());
    EXPECT_EQ(plan.refusal, "") << side;
    EXPECT_TRUE(plan.partial) << side;
  }
}

TEST(Lattice, AGoalOnAnEdgeIsTakenBesideIt) {
  const auto map = field({-1, -1}, {4, 1}, [](double x, double) { return x < 2.0 ? 0.0 : 0.15; });
  const auto planner = make_planner("lattice", atlas(), map);
  const auto gait = standing_gait(0, 0, 0);
  const Goal goal{2.05, 0, 0};
  const Plan plan = planner->plan(start_of(*gait), goal, gait->parameters());
  ASSERT_EQ(plan.refusal, "");
  expect_at(middle_of(plan), goal, 0.15);
  expect_on(*map, plan);
}

TEST(Planners, AStepThatIsUnderWayComesFirst) {
  for (const char* name : {"turn_walk_turn", "lattice"}) {
    const auto map = field({-1, -1}, {4, 1}, [](double, double) { return 0.0; });
    const auto planner = make_planner(name, atlas(), map);
    for (const int side : {GAITD_LEFT, GAITD_RIGHT}) {
      const auto gait = standing_gait(0, 0, 0);
      Start start = start_of(*gait);
      GaitdFootstep step{};
      step.side = side;
      step.pose = start.feet[side];
      step.pose.position[0] += 0.3;
      step.swing_duration = 0.6;
      step.transfer_duration = 0.25;
      start.under_way = step;
      start.feet[side] = step.pose;
      start.first_side = walking::other_side(side);
      Plan plan = planner->plan(start, {2, 0, 0}, gait->parameters());
      ASSERT_EQ(plan.refusal, "") << name;
      EXPECT_EQ(plan.footsteps[0].side, walking::other_side(side)) << name;
      plan.footsteps.insert(plan.footsteps.begin(), step);
      EXPECT_EQ(refusal_of(gait.get(), plan), "") << name;
    }
  }
}

// Of footsteps that know nothing of a platform the last one finds no place on it to stand.
TEST(Planners, WhereNoPlaceIsGoodAFootstepIsAsHighAsTheOneBefore) {
  const auto map = field({1, -1}, {5, 1}, [](double x, double y) {
    if (x < 2.5) return 0.0;
    return x < 3.0 ? 0.1 : 0.1 + 0.03 * std::sin(50 * x) * std::sin(45 * y);
  });
  const auto planner = make_planner("auto", atlas(), map);
  const auto gait = standing_gait(2.25, 0, 0);
  const Start start = start_of(*gait);
  std::vector<GaitdFootstep> ahead;
  ahead.reserve(3);
  for (const double x : {2.7, 2.8, 3.2}) {
    GaitdFootstep step{};
    step.side = ahead.size() % 2 == 0 ? GAITD_LEFT : GAITD_RIGHT;
    step.id = static_cast<std::uint32_t>(10 + ahead.size());
    step.pose = start.feet[step.side];
    step.pose.position[0] = x;
    step.swing_duration = 0.8;
    step.transfer_duration = 0.3;
    step.swing_height = 0.12;
    ahead.push_back(step);
  }
  const std::vector<GaitdFootstep> refined = planner->refine(start, ahead, gait->parameters());
  ASSERT_EQ(refined.size(), 3U);
  for (const GaitdFootstep& step : refined) EXPECT_NEAR(step.pose.position[2], 0.1, 0.005);
  EXPECT_NEAR(refined[2].pose.position[0], 3.2, 1e-9) << "it stays where it was";
}

TEST(Planners, AutoGoesStraightWhereThatGoesAndSearchesWhereNot) {
  const auto map = cinder_blocks();
  const auto planner = make_planner("auto", atlas(), map);
  const auto gait = standing_gait(-0.5, 0, 0);
  const auto& parameters = gait->parameters();
  EXPECT_EQ(planner->plan(start_of(*gait), {0.7, 0.1, 0}, parameters).expansions, 0);
  const Plan over = planner->plan(start_of(*gait), {4.5, 0.0, 0}, parameters);
  EXPECT_EQ(over.refusal, "");
  EXPECT_GT(over.expansions, 0);
}

}  // namespace
}  // namespace gaitd::footsteps
