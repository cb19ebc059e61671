// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli/robot/guess.h"

namespace gaitd::porting {

// The standing posture from the left and from the front as an SVG: links as lines, soles, the
// frames of pelvis, soles, IMU and force sensors, the centre of mass.
std::string posture_picture(const Guess& guess);

}  // namespace gaitd::porting
