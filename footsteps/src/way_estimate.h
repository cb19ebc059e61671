// SPDX-License-Identifier: Apache-2.0
// What the way to a goal costs, about: for the search to know what lies ahead.
#ifndef GAITD_FOOTSTEPS_WAY_ESTIMATE_H_
#define GAITD_FOOTSTEPS_WAY_ESTIMATE_H_

#include <Eigen/Core>
#include <vector>

#include "gaitd/footsteps/way_memory.h"
#include "gaitd/terrain/height_map.h"
#include "step_maker.h"

namespace gaitd::footsteps {

// Shortest ways of the middle of the feet over a coarse grid: cheap where it is level, dear where
// it is not or where nothing is known, and around what the body does not pass. Fast marching
// (Sethian, A fast marching level set method for monotonically advancing fronts, PNAS 1996).
class WayEstimate {
 public:
  // `level` and `uneven`: cost of a metre. `steps` has a map. `memory`: of the ways beside it,
  // learns those on it; may be null.
  WayEstimate(const StepMaker& steps, double level, double uneven, WayMemory* memory);

  // All ways end at `goal` (m, W) from now on; it may be beside the map.
  void lead_to(const Eigen::Vector2d& goal);

  // Cost of the way from `p` (m, W) to the goal.
  double from(const Eigen::Vector2d& p) const;

 private:
  std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(grid_.columns) +
           static_cast<std::size_t>(i);
  }
  double drop(const std::vector<double>& ground, int i, int j) const;
  // Of the cells of grid_ by the map.
  std::vector<Way> ways_on_map(const StepMaker& steps) const;
  // Takes those on the map into the memory, and grid_ and `ways` to all that it knows.
  void recall(double unit, WayMemory* memory, std::vector<Way>* ways);
  double weight(Way way) const;
  // Cost at a cell whose neighbours have theirs, as a front reaches it.
  double arrival(int i, int j) const;

  terrain::Grid grid_;
  const double level_, uneven_;  // cost of a metre
  std::vector<double> weights_;  // by cell, per metre
  std::vector<double> costs_;    // by cell
  Eigen::Vector2d goal_ = Eigen::Vector2d::Constant(terrain::HeightMap::kUnknown);
};

}  // namespace gaitd::footsteps

#endif  // GAITD_FOOTSTEPS_WAY_ESTIMATE_H_
