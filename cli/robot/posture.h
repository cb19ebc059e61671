// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli/robot/guess.h"

namespace gaitd::porting {

// Fills nominal_position of `guess->model`: both soles flat, parallel and side by side under the
// centre of mass, knees bent by 0.5 rad, arms hanging, no joint at a stop. By damped least squares,
// for legs of any geometry. False and why in `error` when the legs do not get there.
bool solve_posture(Guess* guess, std::string* error);

}  // namespace gaitd::porting
