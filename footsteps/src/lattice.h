// SPDX-License-Identifier: Apache-2.0
#ifndef GAITD_FOOTSTEPS_LATTICE_H_
#define GAITD_FOOTSTEPS_LATTICE_H_

#include <memory>
#include <vector>

#include "map_planner.h"
#include "strides.h"
#include "way_estimate.h"

namespace gaitd::footsteps {

// A* over footsteps whose soles are on a lattice of places and headings, aligned with the goal. The
// estimate of what is left is inflated at first, for a way soon, and less so in each search after
// it, for a better one (ARA*). A step is checked, and its swing weighed, when it is taken out of
// the queue, not for each of the thousands that are put in. The same problem has the same answer,
// whatever the machine.
class Lattice : public MapPlanner {
 public:
  Lattice(std::shared_ptr<StepMaker> steps, const PlannerOptions& options);
  Plan plan(const Start& start, const Goal& goal,
            const walking::GaitParameters& parameters) override;

 private:
  class Search;

  const std::vector<Stride> strides_;
  double per_metre_;                  // least cost of a stride over what it leads on
  std::unique_ptr<WayEstimate> way_;  // null: without a map
  const PlannerOptions options_;
};

}  // namespace gaitd::footsteps

#endif  // GAITD_FOOTSTEPS_LATTICE_H_
