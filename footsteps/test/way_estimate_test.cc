// SPDX-License-Identifier: Apache-2.0
#include "way_estimate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <utility>
#include <vector>

#include "footsteps/test/fields.h"
#include "window.h"

namespace gaitd::footsteps {
namespace {

using Eigen::Vector2d;
using testing::atlas;
using testing::field;

constexpr double kLevel = 3.0, kUneven = 9.0;  // steps per metre

WayEstimate to_goal(const std::function<double(double x, double y)>& height, const Vector2d& goal) {
  const StepMaker steps(atlas(), field({-1, -3}, {5, 3}, height));
  WayEstimate way(steps, kLevel, kUneven, nullptr);
  way.lead_to(goal);
  return way;
}

double level(double /*x*/, double /*y*/) { return 0.0; }

TEST(WayEstimate, OnLevelGroundAWayIsAsLongAsItIsFar) {
  const WayEstimate way = to_goal(level, {4.0, 1.0});
  for (const Vector2d& p : {Vector2d(0, 0), Vector2d(0, 1), Vector2d(4, -2), Vector2d(2.3, 2.1)}) {
    const double distance = (p - Vector2d(4.0, 1.0)).norm();
    EXPECT_NEAR(way.from(p), kLevel * distance, 0.05 * kLevel * distance) << p.transpose();
  }
  EXPECT_LT(way.from({4.0, 1.0}), 0.1 * kLevel);
}

TEST(WayEstimate, ItLeadsAroundWhatTheBodyDoesNotPass) {
  // A wall from y = -3 to 1. The arms of Atlas need half a metre beside it.
  const WayEstimate way = to_goal(
      [](double x, double y) { return std::abs(x - 2.0) < 0.1 && y < 1.0 ? 1.2 : 0.0; }, {4, 0});
  const double around = 2.0 * std::hypot(2.0, 1.5);
  EXPECT_GT(way.from({0, 0}), kLevel * around);
  EXPECT_LT(way.from({0, 0}), 1.15 * kLevel * around);
  EXPECT_LT(way.from({2.0, 2.0}), way.from({0, 0}));
  // Somebody who stands at the wall has a way, too.
  EXPECT_TRUE(std::isfinite(way.from({1.8, -2.0})));
}

TEST(WayEstimate, GapsAndBarsAreSteppedOver) {
  for (const double height : {-2.0, 0.15}) {
    const WayEstimate way = to_goal(
        [height](double x, double) { return std::abs(x - 2.0) < 0.08 ? height : 0.0; }, {4, 0});
    EXPECT_GT(way.from({0, 0}), 4.2 * kLevel);
    EXPECT_LT(way.from({0, 0}), 4.0 * kLevel + 1.0 * kUneven);
  }
}

TEST(WayEstimate, BesideTheMapAndWhereNothingIsKnownGroundIsUneven) {
  const WayEstimate beyond = to_goal(level, {8.0, 0.0});
  EXPECT_NEAR(beyond.from({0, 0}), 5.0 * kLevel + 3.0 * kUneven, 0.5 * kLevel);
  EXPECT_NEAR(beyond.from({-3, 0}), 6.0 * kLevel + 5.0 * kUneven, 0.5 * kUneven);
  const WayEstimate unknown =
      to_goal([](double x, double) { return x > 1.0 ? NAN : 0.0; }, {4.0, 0.0});
  EXPECT_NEAR(unknown.from({0, 0}), 1.0 * kLevel + 3.0 * kUneven, kLevel);
}

TEST(WayEstimate, AWallHasABackAndACliffIsNoStep) {
  // Nothing is known behind the front of a wall: it is no way through.
  const WayEstimate wall = to_goal(
      [](double x, double y) {
        if (std::abs(y) > 1.5) return 0.0;
        return x < 2.0 ? 0.0 : x < 2.05 ? 1.2 : NAN;
      },
      {4.0, 0.0});
  EXPECT_GT(wall.from({0, 0}), kLevel * 2.0 * std::hypot(2.0, 1.5));
  EXPECT_LT(wall.from({2.0, 2.2}), wall.from({0, 0}));
  const auto edge = [](double x, double y) { return x < 2.0 && y < 1.0 ? 0.5 : 0.0; };
  EXPECT_GT(to_goal(edge, {4.0, 0.0}).from({0, 0}), 20.0 * kLevel);
}

TEST(WayEstimate, AWallThatLeftTheMapIsStillInTheWay) {
  // From y = -6 to 6; the map of a robot that has walked along it ends at y = -4.
  const auto wall = [](double x, double y) {
    return std::abs(x - 2.0) < 0.1 && std::abs(y) < 6.0 ? 1.2 : 0.0;
  };
  const Vector2d goal(4.0, 0.0), corner(1.4, -6.4);
  const StepMaker along(atlas(), field({-2, -7}, {3, 5}, wall));
  const StepMaker end(atlas(), field({-2, -11}, {3, -4}, wall));
  WayMemory memory;
  const WayEstimate before(along, kLevel, kUneven, &memory);
  WayEstimate forgetful(end, kLevel, kUneven, nullptr), knowing(end, kLevel, kUneven, &memory);
  forgetful.lead_to(goal);
  knowing.lead_to(goal);
  EXPECT_GT(forgetful.from(corner), forgetful.from({1.4, -4.5})) << "back, past where it was";
  EXPECT_LT(knowing.from(corner), knowing.from({1.4, -4.5})) << "around the end";
  memory.clear();
  WayEstimate anew(end, kLevel, kUneven, &memory);
  anew.lead_to(goal);
  EXPECT_NEAR(anew.from(corner), forgetful.from(corner), 1e-9);
}

TEST(Window, TheBestAroundIsTheBestOfAllThatAreNear) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> drawn(-6, 6);
  for (const auto& [columns, rows] : {std::pair{23, 17}, {1, 9}, {9, 1}, {2, 40}}) {
    const terrain::Grid grid{columns, rows, 0.02, {0.0, 0.0}};
    std::vector<float> values(static_cast<std::size_t>(columns * rows));
    for (float& value : values) {
      const int height = drawn(random);
      value = height < -3 ? -INFINITY : static_cast<float>(height);
    }
    for (const int around : {0, 1, 4, 50}) {
      const std::vector<float> highest = best_around(grid, values, around, std::greater<>());
      for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
          float expected = -INFINITY;
          for (int v = std::max(0, j - around); v <= std::min(rows - 1, j + around); ++v) {
            for (int u = std::max(0, i - around); u <= std::min(columns - 1, i + around); ++u) {
              expected = std::max(expected, values[static_cast<std::size_t>(v * columns + u)]);
            }
          }
          ASSERT_EQ(highest[static_cast<std::size_t>(j * columns + i)], expected)
              << i << ' ' << j << " of " << columns << " x " << rows << ", " << around;
        }
      }
    }
  }
}

TEST(WayMemory, MovesWithTheRobotAndForgetsWhatIsFar) {
  WayMemory memory;
  const Vector2d wall(3.05, 0.05);
  memory.remember(wall, Way::kBlocked);
  EXPECT_EQ(memory.at(wall), Way::kUnknown) << "it is nowhere yet";
  memory.move_to({0.0, 0.0}, 0.1);
  memory.remember(wall, Way::kBlocked);
  for (const double x : {5.0, 12.0, 25.0}) {
    memory.move_to({x, 0.0}, 0.1);
    EXPECT_EQ(memory.at(wall), Way::kBlocked) << x;
    EXPECT_EQ(memory.at(wall + Vector2d(0.1, 0.0)), Way::kUnknown) << x;
  }
  terrain::Grid map;
  map.resolution = 0.1;
  map.origin = {25.0, 1.0};
  map.columns = map.rows = 10;
  const terrain::Grid all = memory.around(map);
  EXPECT_NEAR((all.centre(0, 0) - wall).norm(), 0.0, 1e-9);
  EXPECT_NEAR((all.centre(all.columns - 1, all.rows - 1) - map.centre(9, 9)).norm(), 0.0, 1e-9);
  memory.move_to({60.0, 0.0}, 0.1);
  EXPECT_EQ(memory.at(wall), Way::kUnknown);
  memory.move_to({25.0, 0.0}, 0.1);
  EXPECT_EQ(memory.at(wall), Way::kUnknown) << "gone is gone";
  memory.remember({24.05, 0.0}, Way::kLevel);
  memory.move_to({25.0, 0.0}, 0.2);
  EXPECT_EQ(memory.at({24.05, 0.0}), Way::kUnknown) << "other cells";
}

}  // namespace
}  // namespace gaitd::footsteps
