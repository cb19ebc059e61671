// SPDX-License-Identifier: Apache-2.0
// What operators do with a robot: walks, single footsteps, velocities, poses and changes of the
// gait mode, one after another and into each other, and a push now and then.
#pragma once

#include "cli/gauntlet/story.h"

namespace gaitd::cli {

Story session(const Draws& draws);

}  // namespace gaitd::cli
