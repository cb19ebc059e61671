// SPDX-License-Identifier: Apache-2.0
// Where both feet stand at the goal.
#ifndef GAITD_FOOTSTEPS_GOAL_PLACE_H_
#define GAITD_FOOTSTEPS_GOAL_PLACE_H_

#include <array>
#include <string>

#include "footholds.h"
#include "step_maker.h"

namespace gaitd::footsteps {

struct GoalPlace {
  Place middle;  // of the feet
  std::array<Foothold, GAITD_MAX_FEET> footholds;
  // Where none was found: kUnknown if there may be one where the ground is not known, else of what
  // was asked for.
  FootholdState problem = FootholdState::kGood;
  bool found = false;
};

// Of the sole of `side` beside the middle of the feet.
Place sole_beside(const Place& middle, int side, const GaitdModel& model);

// Footholds for both feet at `wanted`, or as near to it as there are any, looked for on a grid of
// `cell` (m).
GoalPlace find_goal_place(const StepMaker& steps, const Place& wanted, double cell);

// Why there is none.
std::string no_goal_place(const Place& wanted, FootholdState problem);

}  // namespace gaitd::footsteps

#endif  // GAITD_FOOTSTEPS_GOAL_PLACE_H_
