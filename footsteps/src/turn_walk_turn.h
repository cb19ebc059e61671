// SPDX-License-Identifier: Apache-2.0
#ifndef GAITD_FOOTSTEPS_TURN_WALK_TURN_H_
#define GAITD_FOOTSTEPS_TURN_WALK_TURN_H_

#include <memory>
#include <utility>

#include "map_planner.h"

namespace gaitd::footsteps {

// Turns on the spot, walks in a straight line, turns on the spot. The line is walked forwards,
// backwards or sideways, whichever takes the fewest footsteps of those that can be taken.
class TurnWalkTurn : public MapPlanner {
 public:
  explicit TurnWalkTurn(std::shared_ptr<StepMaker> steps) : MapPlanner(std::move(steps)) {}
  Plan plan(const Start& start, const Goal& goal,
            const walking::GaitParameters& parameters) override;

 private:
  // One way of walking: by which angle the way is off the heading, and how far a footstep leads.
  struct Manner {
    double angle;   // rad, of the way against the heading
    double stride;  // pelvis heights
  };
  Plan walk(const Start& start, const Goal& goal, const Manner& manner,
            const walking::GaitParameters& parameters) const;
};

}  // namespace gaitd::footsteps

#endif  // GAITD_FOOTSTEPS_TURN_WALK_TURN_H_
