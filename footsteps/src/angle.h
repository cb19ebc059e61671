// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace gaitd::footsteps {

// An angle (rad) as one in -pi..pi.
inline double wrapped(double angle) { return std::remainder(angle, 2.0 * M_PI); }

}  // namespace gaitd::footsteps
