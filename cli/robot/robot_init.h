// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli/robot/guess.h"

namespace gaitd::porting {

// Everything that can be found out about the robot of a URDF, and what somebody told. False and why
// in `error` where it ends: a file that is none, no legs, no sole, no posture.
bool guess_robot(const std::string& urdf, const std::string& name, const Told& told, Guess* guess,
                 std::string* error);

}  // namespace gaitd::porting
