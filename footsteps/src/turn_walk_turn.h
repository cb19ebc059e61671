// SPDX-License-Identifier: Apache-2.0
#ifndef GAITD_FOOTSTEPS_TURN_WALK_TURN_H_
#define GAITD_FOOTSTEPS_TURN_WALK_TURN_H_

#include <memory>

#include "gaitd/footsteps/planner.h"
#include "step_maker.h"

namespace gaitd::footsteps {

// Turns on the spot, walks in a straight line, turns on the spot. The line is walked forwards,
// backwards or sideways, whichever takes the fewest footsteps of those that can be taken.
class TurnWalkTurn : public FootstepPlanner {
 public:
  explicit TurnWalkTurn(std::shared_ptr<StepMaker> steps) : steps_(std::move(steps)) {}
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

  std::shared_ptr<StepMaker> steps_;
};

}  // namespace gaitd::footsteps

#endif  // GAITD_FOOTSTEPS_TURN_WALK_TURN_H_
