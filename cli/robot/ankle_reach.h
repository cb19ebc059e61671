// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/robot/guess.h"

namespace gaitd::porting {

// Cuts the sole of a foot to where its ankle can hold the CoP of the whole robot: beyond, the gait
// would count on moments that the drives do not give. The frame moves to the middle of what is
// left.
void cut_to_ankle(const Guess& guess, int side, SoleGuess* sole);

}  // namespace gaitd::porting
