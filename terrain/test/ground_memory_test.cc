// SPDX-License-Identifier: Apache-2.0
#include "gaitd/terrain/ground_memory.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace gaitd::terrain {
namespace {

constexpr double kSigma = 0.008;  // m, of the points
constexpr double kCommon = 1e-6;  // m^2

// Points on level ground, with a step of `step` (m) up at x = 0.
std::vector<SeenPoint> scan(double step, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> noise(0.0, kSigma);
  std::vector<SeenPoint> points;
  for (int i = -50; i < 50; ++i) {
    for (int j = -30; j < 30; ++j) {
      const double x = 0.012 * i + 0.003, y = 0.012 * j + 0.003;
      points.push_back({{x, y, (x > 0.0 ? step : 0.0) + noise(engine)}, kSigma * kSigma});
    }
  }
  return points;
}

TEST(GroundMemory, ManyScansAverageTheNoiseAndKeepTheEdge) {
  GroundMemory memory;
  memory.move_to({0.0, 0.0});
  for (unsigned k = 0; k < 20; ++k) memory.see(scan(0.15, k), kCommon, 0.1 * k);
  const HeightMap map = memory.map(2.0);
  double worst = 0.0;
  int known = 0;
  for (int j = 0; j < map.grid().rows; ++j) {
    for (int i = 0; i < map.grid().columns; ++i) {
      if (!map.known(i, j)) continue;
      ++known;
      const double x = map.grid().centre(i, j).x();
      worst = std::max(worst, std::abs(map.height(i, j) - (x > 0.0 ? 0.15 : 0.0)));
      EXPECT_LT(map.variance(i, j), 0.004 * 0.004);
    }
  }
  EXPECT_GT(known, 60 * 36 - 200);
  EXPECT_LT(worst, 0.006);
  EXPECT_FALSE(memory.map(1000.0).known_cells() > 0) << "old knowledge is no knowledge";
}

TEST(GroundMemory, OneWrongScanChangesNothingAndTwoAreBelieved) {
  GroundMemory memory;
  memory.move_to({0.0, 0.0});
  for (unsigned k = 0; k < 5; ++k) memory.see(scan(0.0, k), kCommon, 0.1 * k);
  const auto height = [&memory] {
    const HeightMap map = memory.map(1.0);
    return map.surface({0.2, 0.0})->height;
  };
  EXPECT_NEAR(height(), 0.0, 0.006);
  memory.see(scan(0.2, 7), kCommon, 0.6);
  EXPECT_NEAR(height(), 0.0, 0.006);
  memory.see(scan(0.0, 8), kCommon, 0.7);
  memory.see(scan(0.2, 9), kCommon, 0.8);
  EXPECT_NEAR(height(), 0.0, 0.006) << "not in a row";
  memory.see(scan(0.2, 10), kCommon, 0.9);
  EXPECT_NEAR(height(), 0.2, 0.03);
}

TEST(GroundMemory, TheSquareMovesInWholeCellsAndForgetsWhatLeavesIt) {
  GroundMemory memory({.size = 2.0});
  memory.move_to({0.0, 0.0});
  memory.see(scan(0.1, 1), kCommon, 0.0);
  const double before = memory.map(0.0).surface({0.3, 0.1})->height;
  const std::uint64_t revision = memory.revision();
  memory.move_to({1.0, 0.013});
  EXPECT_GT(memory.revision(), revision);
  const HeightMap map = memory.map(0.0);
  ASSERT_TRUE(map.surface({0.3, 0.1}));
  EXPECT_NEAR(map.surface({0.3, 0.1})->height, before, 1e-9);
  EXPECT_FALSE(map.surface({-0.3, 0.1}));
}

TEST(GroundMemory, WhereAFootStandsThereIsGroundUnlessSomethingElseIsKnown) {
  GroundMemory memory;
  memory.move_to({0.0, 0.0});
  const std::array<Eigen::Vector3d, 4> sole = {
      {{-0.1, -0.05, 0.3}, {0.1, -0.05, 0.32}, {0.1, 0.05, 0.32}, {-0.1, 0.05, 0.3}}};
  memory.stand_on(sole, 1e-5, 0.0);
  EXPECT_NEAR(memory.map(0.0).surface({0.02, 0.0})->height, 0.312, 1e-4);
  EXPECT_FALSE(memory.map(0.0).surface({0.15, 0.0}));
  const std::uint64_t revision = memory.revision();
  memory.stand_on(sole, 1e-5, 1.0);
  EXPECT_EQ(memory.revision(), revision);
  EXPECT_FALSE(memory.map(1000.0).surface({0.02, 0.0}));
  memory.stand_on(sole, 1e-5, 1000.0);
  EXPECT_TRUE(memory.map(1000.0).surface({0.02, 0.0})) << "it still stands there";
}

TEST(GroundMemory, WhatDidNotCarryAFootStaysLowWhateverIsSeen) {
  GroundMemory memory;
  memory.move_to({0.0, 0.0});
  for (unsigned k = 0; k < 5; ++k) memory.see(scan(0.0, k), kCommon, 0.1 * k);
  const std::array<Eigen::Vector3d, 4> sole{
      {{-0.3, -0.1, 0.0}, {0.0, -0.1, 0.0}, {0.0, 0.1, 0.0}, {-0.3, 0.1, 0.0}}};
  const std::array<Eigen::Vector3d, 4> bears{
      {{-0.3, -0.1, 0.0}, {-0.16, -0.1, 0.0}, {-0.16, 0.1, 0.0}, {-0.3, 0.1, 0.0}}};
  const auto before = memory.revision();
  memory.sink(sole, bears, 0.6);
  EXPECT_GT(memory.revision(), before);
  const auto again = memory.revision();
  memory.sink(sole, bears, 0.7);
  EXPECT_EQ(memory.revision(), again) << "nothing new";
  for (unsigned k = 0; k < 5; ++k) memory.see(scan(0.0, 10 + k), kCommon, 0.8 + 0.1 * k);
  const HeightMap map = memory.map(200.0);  // nor is it forgotten
  const auto height = [](const HeightMap& map, double x) {
    const Eigen::Vector2i c = map.grid().cell({x, 0.0});
    return map.height(c.x(), c.y());
  };
  EXPECT_NEAR(height(map, -0.07), -memory.rules().hollow, 1e-6);
  EXPECT_NEAR(height(map, -0.25), 0.0, 0.01);
  EXPECT_NEAR(height(map, 0.1), 0.0, 0.01);
  HeightMap tile(Grid{30, 10, 0.02, {-0.3, -0.1}});
  for (int j = 0; j < 10; ++j) {
    for (int i = 0; i < 30; ++i) tile.set(i, j, 0.05, 1e-6);
  }
  memory.put(tile, false, 2.0);
  EXPECT_NEAR(height(memory.map(2.0), -0.07), 0.05, 1e-6) << "somebody knows better";
}

TEST(GroundMemory, ATileTakesThePlaceOfWhatWasKnown) {
  GroundMemory memory;
  memory.move_to({0.0, 0.0});
  memory.see(scan(0.0, 1), kCommon, 0.0);
  HeightMap tile(Grid{10, 10, 0.02, {0.0, 0.0}});
  for (int j = 0; j < 10; ++j) {
    for (int i = 0; i < 5; ++i) tile.set(i, j, 0.5, 1e-6);
  }
  memory.put(tile, false, 1.0);
  EXPECT_NEAR(memory.map(1.0).surface({0.04, 0.1})->height, 0.5, 1e-6);
  EXPECT_TRUE(memory.map(1.0).surface({0.16, 0.1})) << "its unknown cells say nothing";
  memory.put(tile, true, 1.0);
  EXPECT_FALSE(memory.map(1.0).surface({0.16, 0.1}));
  memory.clear();
  EXPECT_EQ(memory.map(1.0).known_cells(), 0);
}

// Of cells of `resolution` (m) over a square of `size` (m) with a corner at `corner` (m).
HeightMap tile_of(double corner, double size, double resolution, double height, double variance) {
  const int count = static_cast<int>(std::lround(size / resolution));
  HeightMap tile(Grid{count, count, resolution, {corner, corner}});
  for (int j = 0; j < count; ++j) {
    for (int i = 0; i < count; ++i) tile.set(i, j, height, variance);
  }
  return tile;
}

TEST(GroundMemory, WhatIsToldAndUncertainIsNotKnown) {
  GroundMemory memory;
  memory.move_to({0.0, 0.0});
  for (unsigned k = 0; k < 5; ++k) memory.see(scan(0.0, k), kCommon, 0.1 * k);
  ASSERT_TRUE(memory.map(0.5).surface({0.0, 0.0}));
  const GroundMemory::Taken taken =
      memory.put(tile_of(-0.2, 0.4, 0.02, 0.0, 0.04 * 0.04), false, 0.5);
  EXPECT_EQ(taken.cells, 0);
  EXPECT_EQ(taken.uncertain, 400);
  EXPECT_EQ(taken.far, 0);
  const HeightMap map = memory.map(0.5);
  const Eigen::Vector2i c = map.grid().cell({0.01, 0.01});
  EXPECT_FALSE(map.known(c.x(), c.y()));
  EXPECT_TRUE(std::isinf(map.variance(c.x(), c.y()))) << "somebody says so";
  EXPECT_EQ(memory.put(tile_of(5.8, 0.4, 0.02, 0.0, 1e-6), false, 0.5).far, 300);
}

TEST(GroundMemory, OneUncertainCellIsNoHoleOfASensor) {
  GroundMemory memory;
  memory.move_to({0.0, 0.0});
  HeightMap tile = tile_of(0.0, 0.4, 0.01, 0.0, 1e-6);
  tile.set(20, 20, 0.0, 0.04 * 0.04);
  const GroundMemory::Taken taken = memory.put(tile, false, 0.0);
  EXPECT_EQ(taken.cells, 1596);
  EXPECT_EQ(taken.uncertain, 4) << "all in that cell of the map";
  const HeightMap map = memory.map(0.0);
  const Eigen::Vector2i c = map.grid().cell({0.205, 0.205});
  EXPECT_FALSE(map.known(c.x(), c.y()));
  EXPECT_TRUE(std::isinf(map.variance(c.x(), c.y())));
  EXPECT_EQ(map.known_cells(), 399);
}

TEST(GroundMemory, OfSmallerCellsTheHighestCounts) {
  GroundMemory memory;
  memory.move_to({0.0, 0.0});
  HeightMap tile = tile_of(0.0, 0.4, 0.005, 0.0, 1e-6);
  for (int j = 0; j < 80; ++j) tile.set(40, j, 0.5, 1e-6);  // none is in the middle of a larger one
  for (int j = 0; j < 80; ++j) {
    for (int i = 60; i < 80; i += 4) tile.set(i, j, HeightMap::kUnknown);
  }
  EXPECT_EQ(memory.put(tile, false, 0.0).cells, 80 * 75);
  const auto height = [&memory](double x) {
    const HeightMap map = memory.map(0.0);
    const Eigen::Vector2i c = map.grid().cell({x, 0.25});
    return map.height(c.x(), c.y());
  };
  EXPECT_NEAR(height(0.19), 0.0, 1e-6);
  EXPECT_NEAR(height(0.21), 0.5, 1e-6);
  EXPECT_NEAR(height(0.23), 0.0, 1e-6);
  EXPECT_NEAR(height(0.35), 0.0, 1e-6) << "unknown cells say nothing";
  memory.put(tile, true, 0.0);
  EXPECT_TRUE(std::isnan(height(0.35)));
  EXPECT_NEAR(height(0.21), 0.5, 1e-6);
  // A cell that a tile fills in part is left as it is.
  const GroundMemory::Taken taken = memory.put(tile_of(0.205, 0.1, 0.005, 0.0, 1e-6), false, 0.0);
  EXPECT_EQ(taken.cells, 16 * 16);
  EXPECT_EQ(taken.partly, 20 * 20 - 16 * 16);
  EXPECT_NEAR(height(0.21), 0.5, 1e-6);
  EXPECT_NEAR(height(0.23), 0.0, 1e-6);
}

TEST(GroundMemory, WhatWasFoundIsForgottenApartFromWhatWasTold) {
  GroundMemory memory;
  memory.move_to({0.0, 0.0});
  for (unsigned k = 0; k < 5; ++k) memory.see(scan(0.0, k), kCommon, 0.1 * k);
  memory.put(tile_of(0.2, 0.2, 0.02, 0.5, 1e-6), false, 0.5);
  const std::uint64_t revision = memory.revision();
  memory.clear_found();
  EXPECT_GT(memory.revision(), revision);
  const HeightMap map = memory.map(0.5);
  EXPECT_FALSE(map.surface({-0.3, 0.0}));
  ASSERT_TRUE(map.surface({0.3, 0.3}));
  EXPECT_NEAR(map.surface({0.3, 0.3})->height, 0.5, 1e-6);
}

TEST(GroundMemory, WhatWasToldHolds) {
  GroundMemory memory;
  memory.move_to({0.0, 0.0});
  HeightMap tile(Grid{10, 10, 0.02, {0.0, 0.0}});
  for (int j = 0; j < 10; ++j) {
    for (int i = 0; i < 10; ++i) tile.set(i, j, 0.5, i < 5 ? 1e-6 : 1e-3);
  }
  EXPECT_EQ(memory.put(tile, false, 1.0).cells, 50) << "the others are too uncertain to step on";
  EXPECT_NEAR(memory.map(1e5).surface({0.04, 0.1})->height, 0.5, 1e-6);
  for (unsigned k = 0; k < 3; ++k) memory.see(scan(0.5, k), kCommon, 2.0 + k);
  EXPECT_NEAR(memory.map(1e5).surface({0.04, 0.1})->height, 0.5, 0.02) << "and was seen";
  for (unsigned k = 0; k < 3; ++k) memory.see(scan(0.0, k), kCommon, 2.0 + k);
  EXPECT_NEAR(memory.map(5.0).surface({0.04, 0.1})->height, 0.0, 0.02) << "it was seen otherwise";
  EXPECT_FALSE(memory.map(1e5).surface({0.04, 0.1})) << "which grows old";
}

TEST(GroundMemory, PointsThatAreNoNumbersOrFarAwayAreLeftOut) {
  GroundMemory memory;
  memory.move_to({0.0, 0.0});
  const std::vector<SeenPoint> wrong = {
      {{NAN, 0, 0}, 1e-4}, {{0, 0, INFINITY}, 1e-4}, {{1e9, 0, 0}, 1e-4}, {{0, 0, 0}, 0.0}};
  memory.see(wrong, kCommon, 0.0);
  EXPECT_EQ(memory.map(0.0).known_cells(), 0);
  EXPECT_EQ(memory.revision(), GroundMemory().revision());
  EXPECT_NE(memory.revision(), 0U) << "who asks has seen none yet";
}

}  // namespace
}  // namespace gaitd::terrain
