// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/robot/guess.h"

namespace gaitd::porting {

// Effort, velocity and range of leg joints where the URDF gives none, or a placeholder: in
// proportion to Atlas. Fills `guess->drive_limits` and the joints of `guess->model`, which has its
// posture.
void guess_drive_limits(Guess* guess);

}  // namespace gaitd::porting
