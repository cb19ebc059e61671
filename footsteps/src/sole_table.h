// SPDX-License-Identifier: Apache-2.0
// What a search knows of the places for a foot: each is looked up on the map once.
#ifndef GAITD_FOOTSTEPS_SOLE_TABLE_H_
#define GAITD_FOOTSTEPS_SOLE_TABLE_H_

#include <array>
#include <cstdint>
#include <memory_resource>
#include <unordered_map>

#include "gaitd/footsteps/planner.h"
#include "goal_place.h"
#include "step_maker.h"
#include "way_estimate.h"

namespace gaitd::footsteps {

struct SolePlace {
  int side = 0;
  Place place;
  Foothold foothold;
  double way = 0.0;       // steps, of the middle of the feet if the other one stood beside it
  double estimate = 0.0;  // steps to the goal, at least
  int closed_in = 0;      // the search that expanded it last
};

// The soles of the start, of the goal, and of a lattice with the goal as its origin.
class SoleTable {
 public:
  // `per_metre`: steps; `cell`: m. `way` may be null; else it leads to this goal.
  SoleTable(const StepMaker& steps, const WayEstimate* way, double per_metre, double cell,
            const Start& start, const GoalPlace& goal);

  SolePlace& start(int side) { return start_[static_cast<std::size_t>(side)]; }
  SolePlace& goal(int side) { return goal_[static_cast<std::size_t>(side)]; }
  // The one of the lattice that is nearest to `place`.
  SolePlace& nearest(int side, const Place& place);

 private:
  void weigh(SolePlace* sole) const;

  const StepMaker& steps_;
  const WayEstimate* const way_;
  const double per_metre_;  // steps
  const double cell_;       // m
  const Place middle_;      // of the feet at the goal
  std::array<SolePlace, GAITD_MAX_FEET> start_, goal_;
  std::pmr::monotonic_buffer_resource memory_;
  std::pmr::unordered_map<std::uint64_t, SolePlace> lattice_{&memory_};
};

}  // namespace gaitd::footsteps

#endif  // GAITD_FOOTSTEPS_SOLE_TABLE_H_
