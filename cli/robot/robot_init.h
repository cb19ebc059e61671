// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli/robot/guess.h"

namespace gaitd::porting {

// Everything that can be found out about the robot of a URDF, with the joints of `fix`, names or
// globs, taken for fixed. False and why in `error` where it
// ends: a file that is none, no legs, no sole, no posture.
bool guess_robot(const std::string& urdf, const std::string& name,
                 const std::vector<std::string>& fix, Guess* guess, std::string* error);

}  // namespace gaitd::porting
