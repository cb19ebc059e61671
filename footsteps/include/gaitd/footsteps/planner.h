// SPDX-License-Identifier: Apache-2.0
// From where the feet stand to a place in the world: footsteps that the gait machine accepts. Plain
// deterministic searches, bounded by a count and not by a time; they allocate, and have no place in
// a tick.
#ifndef GAITD_FOOTSTEPS_PLANNER_H_
#define GAITD_FOOTSTEPS_PLANNER_H_

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gaitd/abi/types.h"
#include "gaitd/footsteps/way_memory.h"
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
  // m, W: where plans have ended before, without seeing more from there. Not to end there again.
  std::span<const Eigen::Vector2d> exhausted{};
};

struct Plan {
  std::vector<GaitdFootstep> footsteps;  // alternating; with all durations and swing heights
  std::string refusal;                   // why there is no way; empty: there is one
  int expansions = 0;                    // of the search
  double cost = 0.0;                     // steps, to the goal, as the search weighs them
  bool partial = false;                  // it ends where the ground is not known any more
};

class FootstepPlanner {
 public:
  virtual ~FootstepPlanner() = default;
  // `parameters` are those of the gait that will check the footsteps.
  virtual Plan plan(const Start& start, const Goal& goal,
                    const walking::GaitParameters& parameters) = 0;

  // What is left of a plan, on the map of this planner: the same places, with heights, tilts, times
  // and regions as the ground has them. Ends before the first that cannot be taken any more; then
  // the refusal says why.
  virtual Plan adapt(const Start& start, const std::vector<GaitdFootstep>& ahead,
                     const walking::GaitParameters& parameters) = 0;

  // Footsteps of somebody who does not know the ground: put on it where it is known, and beside an
  // edge (kAside) that they would stand on. Only those that change, with their `id`.
  virtual std::vector<GaitdFootstep> refine(const Start& start,
                                            const std::vector<GaitdFootstep>& ahead,
                                            const walking::GaitParameters& parameters) = 0;
  static constexpr double kAside = 0.08;  // m

  // m: height of the middle of the sole of `side`, if it lay on the map; nothing where that is not
  // known. What it stands on half in the air does not count.
  virtual std::optional<double> ground_below(int side, const GaitdPose& sole) const = 0;
};

// Whether two poses of a sole are one foothold, but for the noise of a map.
bool same_foothold(const GaitdPose& a, const GaitdPose& b);

struct PlannerOptions {
  int expansions = 20000;  // at most, of the lattice
  bool explore = false;    // the map grows: plan to where it ends if the goal is beyond
  // Of what has left it; null: nothing is remembered.
  std::shared_ptr<WayMemory> ways{};
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
