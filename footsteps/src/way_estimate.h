// SPDX-License-Identifier: Apache-2.0
// What the straight way to a goal costs, about: for the search to know what lies ahead.
#ifndef GAITD_FOOTSTEPS_WAY_ESTIMATE_H_
#define GAITD_FOOTSTEPS_WAY_ESTIMATE_H_

#include <Eigen/Core>
#include <vector>

#include "gaitd/terrain/height_map.h"

namespace gaitd::footsteps {

// Over a coarse grid, cheap where it is level and dear where it is not.
class WayEstimate {
 public:
  // `unit`: m, height of the pelvis. `level` and `uneven`: cost of a metre.
  WayEstimate(const terrain::HeightMap& map, double unit, double level, double uneven);

  // Cost of the straight way; beside the map that of the nearest cells.
  double between(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const;

 private:
  terrain::Grid grid_;
  std::vector<double> weights_;  // by cell, per metre
};

}  // namespace gaitd::footsteps

#endif  // GAITD_FOOTSTEPS_WAY_ESTIMATE_H_
