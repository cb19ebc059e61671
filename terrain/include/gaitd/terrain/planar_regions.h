// SPDX-License-Identifier: Apache-2.0
// The planes of a height map, and convex parts of them.
#ifndef GAITD_TERRAIN_PLANAR_REGIONS_H_
#define GAITD_TERRAIN_PLANAR_REGIONS_H_

#include <Eigen/Core>
#include <vector>

#include "gaitd/abi/types.h"
#include "gaitd/terrain/height_map.h"

namespace gaitd::terrain {

struct RegionRules {
  double distance = 0.01;    // m, of the cells from the plane of their region
  double roughness = 0.005;  // m, of the 5 x 5 cells around one from which a region may grow
  double angle = 0.15;       // rad, between the normal of a smooth cell and that of its region
  double max_slope = 0.7;    // rad, of a region
  double least_area = 0.01;  // m^2, of a region, and of a convex part of one
};

struct PlanarRegion {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();   // m, W, on the plane
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit, W, upwards
  double area = 0.0;                                  // m^2, of its cells, seen from above
  // Its convex parts, W: each of 3 to GAITD_MAX_REGION_POINTS points, counter-clockwise from above,
  // through centres of cells. No cell that is known to be off the plane, or that is unknown, has
  // its centre in one. They may overlap and need not cover the region.
  std::vector<std::vector<Eigen::Vector3d>> parts;

  double height(const Eigen::Vector2d& p) const {  // m, W, of the plane at `p`
    return centre.z() - normal.head<2>().dot(p - centre.head<2>()) / normal.z();
  }
};

struct PlanarRegions {
  std::vector<PlanarRegion> regions;
  std::vector<int> labels;  // by cell, row by row: index of its region, or -1
};

// Region growing from smooth cells, in the order of the cells: the same map, the same regions.
PlanarRegions find_planar_regions(const HeightMap& map, const RegionRules& rules = {});

}  // namespace gaitd::terrain

#endif  // GAITD_TERRAIN_PLANAR_REGIONS_H_
