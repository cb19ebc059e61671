// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/robot/guess.h"

namespace gaitd::porting {

// Joints that a walking robot keeps fixed: those that mimic another one, fingers and grippers, and
// those of whose drive the URDF gives no effort or no velocity.
std::vector<FixedGuess> joints_to_fix(const dynamics::UrdfOutline& outline);

// The last of these by name, for an error; empty if there are none.
std::string joints_without_limits(const dynamics::UrdfOutline& outline);

}  // namespace gaitd::porting
