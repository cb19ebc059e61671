// SPDX-License-Identifier: Apache-2.0
// Compares what a motor says of itself with the wiring.
#pragma once

#include <string>

#include "wiring.h"

namespace gaitd::can {

struct MotorRegisters {
  float position_range = 0;   // PMAX, rad
  float velocity_range = 0;   // VMAX, rad/s
  float torque_range = 0;     // TMAX, N m
  uint32_t timeout = 0;       // kTimeoutUnit
  uint32_t control_mode = 0;  // kMitControlMode
};

// Everything that forbids to switch the motor on, "" if nothing does. `longest_timeout`: s.
std::string check_registers(const MotorRegisters& registers, const Ranges& ranges,
                            double longest_timeout);

}  // namespace gaitd::can
