// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "exchange.h"
#include "settings.h"

namespace gaitd::unitree {

// What a motor is told for the command of its joint: inside the limits of the joint and of the
// settings. A command with a figure that is none damps.
MotorTarget motor_target(const GaitdJointCommand& command, const GaitdJoint& joint,
                         const Settings& settings);

}  // namespace gaitd::unitree
