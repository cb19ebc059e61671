// SPDX-License-Identifier: Apache-2.0
#include "gaitd/terrain/height_map.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

namespace gaitd::terrain {
namespace {

HeightMap plane(double slope_x, double slope_y) {
  HeightMap map(Grid{40, 30, 0.05, {-1.0, 0.5}});
  for (int j = 0; j < map.grid().rows; ++j) {
    for (int i = 0; i < map.grid().columns; ++i) {
      const Eigen::Vector2d p = map.grid().centre(i, j);
      map.set(i, j, slope_x * p.x() + slope_y * p.y() + 0.1);
    }
  }
  return map;
}

TEST(HeightMap, APlaneHasItsHeightAndNormalEverywhere) {
  const HeightMap map = plane(0.2, -0.1);
  const Eigen::Vector3d normal = Eigen::Vector3d(-0.2, 0.1, 1.0).normalized();
  for (const Eigen::Vector2d& p :
       {Eigen::Vector2d(-0.97, 0.53), Eigen::Vector2d(0.0, 1.0), Eigen::Vector2d(0.91, 1.93)}) {
    const auto surface = map.surface(p);
    ASSERT_TRUE(surface) << p.transpose();
    EXPECT_NEAR(surface->height, 0.2 * p.x() - 0.1 * p.y() + 0.1, 1e-12);
    EXPECT_NEAR((surface->normal - normal).norm(), 0.0, 1e-12);
  }
}

TEST(HeightMap, WhatIsNotKnownHasNoSurface) {
  HeightMap map = plane(0.0, 0.0);
  EXPECT_FALSE(map.surface({-1.01, 1.0}));
  EXPECT_FALSE(map.surface({0.99, 1.0})) << "beyond the last centre";
  EXPECT_TRUE(map.surface({0.975, 1.0}));
  EXPECT_FALSE(map.surface({NAN, 1.0}));
  map.set(20, 10, HeightMap::kUnknown);
  EXPECT_FALSE(map.surface(map.grid().centre(20, 10) + Eigen::Vector2d(0.04, 0.0)));
  EXPECT_TRUE(map.surface(map.grid().centre(20, 10) + Eigen::Vector2d(0.06, 0.0)));
  EXPECT_EQ(map.known_cells(), 40 * 30 - 1);
}

TEST(HeightMap, CellsAreWhereTheGridSays) {
  const Grid grid{40, 30, 0.05, {-1.0, 0.5}};
  EXPECT_EQ(grid.cell({-0.999, 0.501}), Eigen::Vector2i(0, 0));
  EXPECT_EQ(grid.cell({-1.001, 2.001}), Eigen::Vector2i(-1, 30));
  EXPECT_EQ(grid.cell(grid.centre(7, 9)), Eigen::Vector2i(7, 9));
  EXPECT_FALSE(grid.contains(40, 0));
  EXPECT_TRUE(grid.contains(39, 29));
}

TEST(HeightMap, BoxesRaiseTheCellsBelowThem) {
  HeightMap map = plane(0.0, 0.0);  // at 0.1
  BoxShape level{{0.0, 1.0, 0.1}, {0.2, 0.1, 0.15}, Eigen::Matrix3d::Identity()};
  BoxShape tilted = level;
  tilted.center = {-0.6, 1.0, 0.3};
  tilted.R_WB = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY()).toRotationMatrix();
  BoxShape sunk = level;
  sunk.center = {0.6, 1.0, -0.5};
  add_boxes({level, tilted, sunk}, &map);
  EXPECT_NEAR(map.surface({0.05, 1.0})->height, 0.25, 1e-12);
  EXPECT_NEAR(map.surface({0.3, 1.0})->height, 0.1, 1e-12);
  EXPECT_NEAR(map.surface({0.6, 1.0})->height, 0.1, 1e-12) << "below the ground";
  const auto top = map.surface({-0.6, 1.0});
  EXPECT_NEAR(top->height, 0.3 + 0.15 / std::cos(0.3), 1e-12);
  EXPECT_NEAR((top->normal - tilted.R_WB.col(2)).norm(), 0.0, 1e-9);
}

TEST(HeightMap, BoxesBesideTheMapChangeNothing) {
  HeightMap map = plane(0.0, 0.0);
  add_boxes({{{-3.0, 1.0, 0.1}, {0.2, 0.1, 0.15}, Eigen::Matrix3d::Identity()}}, &map);
  EXPECT_EQ(map.height(0, 10), 0.1);
}

}  // namespace
}  // namespace gaitd::terrain
