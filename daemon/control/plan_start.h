// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gaitd/footsteps/planner.h"
#include "gaitd/walking/gait_machine.h"

namespace gaitd::daemon {

// The feet as they stand, in the frame of commands. [rt]
footsteps::Start standing_start(const walking::GaitMachine& gait);

// Where footsteps begin that replace all that have not begun: behind the step that is being taken
// or that a transfer has chosen. [rt]
footsteps::Start plan_start(const walking::GaitMachine& gait);

// Whether the footstep under way is still in the queue's part that a replacement drops, so that it
// has to be sent with it: a transfer has chosen it, its swing has not begun.
bool is_chosen_only(const walking::GaitMachine& gait);

// Whether a plan from `planned` fits a robot at `now`: the same step under way, the feet in place.
bool still_fits(const footsteps::Start& planned, const footsteps::Start& now);

}  // namespace gaitd::daemon
