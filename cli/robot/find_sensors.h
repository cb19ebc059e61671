// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/robot/guess.h"

namespace gaitd::porting {

// The IMU: a sensor or link of that kind in the pelvis, else behind the joints of the waist, else
// one that is proposed at the origin of the pelvis.
FrameGuess find_imu(const Guess& guess);

// The force sensor of a foot: a sensor or link of that kind on the foot, else one that is proposed
// at its origin with z up.
FrameGuess find_force_sensor(const Guess& guess, int side);

// The body that carries most of what is above the legs, when joints lead to it; a link name, empty
// for the pelvis itself.
std::string find_chest(const Guess& guess, Reasons* why);

}  // namespace gaitd::porting
