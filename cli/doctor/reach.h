// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gaitd/abi/types.h"

namespace gaitd::doctor {

// m, from the pelvis origin to the sole with straight legs side by side.
double leg_length(const GaitdModel& model);

// m, between the soles: the pelvis in the middle, lowered to 0.8 of `leg_length`.
double longest_step(double leg_length);

}  // namespace gaitd::doctor
