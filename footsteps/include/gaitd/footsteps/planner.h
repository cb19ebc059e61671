// SPDX-License-Identifier: Apache-2.0
// From where the feet stand to a place in the world: footsteps that the gait machine accepts. Plain
// deterministic searches, bounded by a count and not by a time; they allocate, and have no place in
// a tick.
#ifndef GAITD_FOOTSTEPS_PLANNER_H_
#define GAITD_FOOTSTEPS_PLANNER_H_

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gaitd/abi/types.h"
#include "gaitd/terrain/height_map.h"
#include "gaitd/walking/footsteps.h"

namespace gaitd::footsteps {

// Where the plan begins: behind the footsteps that are taken whatever it says.
struct Start {
  GaitdPose feet[GAITD_MAX_FEET] = {};  // soles, W
  int first_side = GAITD_BOTH;          // of the foot that has to step first; GAITD_BOTH: either
  double omega = 3.0;                   // 1/s, natural frequency of the ICP
  // The footstep that is being taken, which lands at the pose of its foot.
  std::optional<GaitdFootstep> under_way;
};

// Where the middle of the feet is to be, W.
struct Goal {
  double x = 0.0, y = 0.0;    // m
  std::optional<double> yaw;  // rad; none: as it comes
};

struct Plan {
  std::vector<GaitdFootstep> footsteps;  // alternating; with all durations and swing heights
  std::string refusal;                   // why there is no way; empty: there is one
  int expansions = 0;                    // of the search
};

class FootstepPlanner {
 public:
  virtual ~FootstepPlanner() = default;
  // `parameters` are those of the gait that will check the footsteps.
  virtual Plan plan(const Start& start, const Goal& goal,
                    const walking::GaitParameters& parameters) = 0;
};

struct PlannerOptions {
  int expansions = 20000;  // at most, of the lattice
};

inline constexpr std::string_view kPlannerNames[] = {"auto", "lattice", "turn_walk_turn"};

// `name` is one of kPlannerNames.
//   turn_walk_turn  turns, walks straight and turns again, or walks backwards or sideways there,
//                   whichever takes the fewest steps; every foothold has to be good on the map
//   lattice         anytime A* over footsteps on a lattice; needs a map
//   auto            turn_walk_turn where that goes, else the lattice
// `map` is the ground, W; null: level, at the height of the feet. The model is copied.
std::unique_ptr<FootstepPlanner> make_planner(std::string_view name, const GaitdModel& model,
                                              std::shared_ptr<const terrain::HeightMap> map,
                                              const PlannerOptions& options = {});

}  // namespace gaitd::footsteps

#endif  // GAITD_FOOTSTEPS_PLANNER_H_
