// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "daemon/verdict/run_data.h"

namespace gaitd::daemon {

// How well a robot that is driven keeps the velocity of its steps: relative error of the mean
// velocity, horizontal and turning, over an even number of steps of the same velocity, of which the
// first is not counted; the mean over all such stretches by their time. NaN if there is none, or
// the log does not have the velocities.
double drive_speed_error(const RunData& run);

}  // namespace gaitd::daemon
