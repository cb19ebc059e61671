// SPDX-License-Identifier: Apache-2.0
#include "gaitd/terrain/planar_regions.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace gaitd::terrain {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

HeightMap ground(double width, double depth) {
  HeightMap map(Grid{static_cast<int>(width / 0.02), static_cast<int>(depth / 0.02), 0.02, {0, 0}});
  for (int j = 0; j < map.grid().rows; ++j) {
    for (int i = 0; i < map.grid().columns; ++i) map.set(i, j, 0.0);
  }
  return map;
}

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

double area_of(const std::vector<Vector3d>& part) {
  double twice = 0.0;
  for (std::size_t i = 0; i < part.size(); ++i) {
    twice += cross(part[i].head<2>(), part[(i + 1) % part.size()].head<2>());
  }
  return 0.5 * twice;
}

bool contains(const std::vector<Vector3d>& part, const Vector2d& p) {
  for (std::size_t i = 0; i < part.size(); ++i) {
    const Vector2d a = part[i].head<2>(), b = part[(i + 1) % part.size()].head<2>();
    if (cross(b - a, p - a) < -1e-9) return false;
  }
  return true;
}

// What every set of regions has to fulfil.
void expect_sound(const HeightMap& map, const PlanarRegions& found) {
  const Grid& grid = map.grid();
  for (std::size_t r = 0; r < found.regions.size(); ++r) {
    for (const auto& part : found.regions[r].parts) {
      ASSERT_GE(part.size(), 3u);
      ASSERT_LE(part.size(), std::size_t{GAITD_MAX_REGION_POINTS});
      for (std::size_t i = 0; i < part.size(); ++i) {
        const Vector3d& a = part[i];
        const Vector3d& b = part[(i + 1) % part.size()];
        const Vector3d& c = part[(i + 2) % part.size()];
        EXPECT_GT(cross((b - a).head<2>(), (c - b).head<2>()), 0.0) << "convex, counter-clockwise";
        EXPECT_NEAR(a.z(), found.regions[r].height(a.head<2>()), 1e-9);
      }
      for (int j = 0; j < grid.rows; ++j) {
        for (int i = 0; i < grid.columns; ++i) {
          if (!contains(part, grid.centre(i, j))) continue;
          ASSERT_EQ(found.labels[static_cast<std::size_t>(j * grid.columns + i)],
                    static_cast<int>(r));
        }
      }
    }
  }
}

double covered(const HeightMap& map, const PlanarRegion& region) {
  int inside = 0;
  for (int j = 0; j < map.grid().rows; ++j) {
    for (int i = 0; i < map.grid().columns; ++i) {
      inside += std::any_of(region.parts.begin(), region.parts.end(), [&](const auto& part) {
        return contains(part, map.grid().centre(i, j));
      });
    }
  }
  return inside * map.grid().resolution * map.grid().resolution;
}

TEST(PlanarRegions, LevelGroundIsOneRectangle) {
  const HeightMap map = ground(3.0, 2.0);
  const PlanarRegions found = find_planar_regions(map);
  ASSERT_EQ(found.regions.size(), 1u);
  ASSERT_EQ(found.regions[0].parts.size(), 1u);
  EXPECT_EQ(found.regions[0].parts[0].size(), 4u);
  EXPECT_NEAR(area_of(found.regions[0].parts[0]), 2.98 * 1.98, 1e-9);
  expect_sound(map, found);
}

TEST(PlanarRegions, EachFaceOfAFieldOfBlocksIsOne) {
  HeightMap map = ground(3.0, 2.0);
  BoxShape level{{0.8, 1.0, 0.0}, {0.2, 0.2, 0.15}, Eigen::Matrix3d::Identity()};
  BoxShape turned = level;
  turned.center.x() = 1.5;
  turned.R_WB = Eigen::AngleAxisd(0.5, Vector3d::UnitZ()).toRotationMatrix();
  BoxShape tilted = level;
  tilted.center.x() = 2.2;
  tilted.R_WB = Eigen::AngleAxisd(0.26, Vector3d::UnitY()).toRotationMatrix();
  add_boxes({level, turned, tilted}, &map);
  const PlanarRegions found = find_planar_regions(map);
  ASSERT_EQ(found.regions.size(), 4u);
  expect_sound(map, found);
  for (const BoxShape& box : {level, turned, tilted}) {
    const auto region =
        std::find_if(found.regions.begin(), found.regions.end(), [&](const PlanarRegion& r) {
          return (r.centre - box.center).head<2>().norm() < 0.06 && r.centre.z() > 0.05;
        });
    ASSERT_NE(region, found.regions.end()) << box.center.transpose();
    EXPECT_LT(region->normal.cross(box.R_WB.col(2)).norm(), 0.01);
    ASSERT_EQ(region->parts.size(), 1u);
    EXPECT_GT(area_of(region->parts[0]), 0.36 * 0.36);
  }
  // The ground around them: most of it is in convex parts.
  const auto level_ground = std::max_element(
      found.regions.begin(), found.regions.end(),
      [](const PlanarRegion& a, const PlanarRegion& b) { return a.area < b.area; });
  EXPECT_GT(covered(map, *level_ground), 0.8 * level_ground->area);
}

TEST(PlanarRegions, ARampAndTheGroundAreTwo) {
  HeightMap map = ground(3.0, 1.0);
  for (int j = 0; j < map.grid().rows; ++j) {
    for (int i = 0; i < map.grid().columns; ++i) {
      const double x = map.grid().centre(i, j).x();
      if (x > 1.5) map.set(i, j, 0.3 * (x - 1.5));
    }
  }
  const PlanarRegions found = find_planar_regions(map);
  ASSERT_EQ(found.regions.size(), 2u);
  EXPECT_NEAR(found.regions[0].normal.z(), 1.0, 1e-3);
  EXPECT_NEAR(std::acos(found.regions[1].normal.z()), std::atan(0.3), 5e-3);
  expect_sound(map, found);
}

TEST(PlanarRegions, HolesAndWhatIsUnknownAreInNoPart) {
  HeightMap map = ground(2.0, 2.0);
  for (int j = 45; j < 55; ++j) {
    for (int i = 40; i < 60; ++i) map.set(i, j, j < 50 ? HeightMap::kUnknown : -1.0);
  }
  const PlanarRegions found = find_planar_regions(map);
  ASSERT_GE(found.regions.size(), 1u);
  expect_sound(map, found);
  EXPECT_GT(covered(map, found.regions[0]), 0.9 * found.regions[0].area);
}

TEST(PlanarRegions, RubbleHasNone) {
  HeightMap map = ground(1.0, 1.0);
  for (int j = 0; j < 50; ++j) {
    for (int i = 0; i < 50; ++i) map.set(i, j, 0.03 * ((i * 7 + j * 13) % 5));
  }
  EXPECT_TRUE(find_planar_regions(map).regions.empty());
}

}  // namespace
}  // namespace gaitd::terrain
