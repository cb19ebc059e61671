// SPDX-License-Identifier: Apache-2.0
#include "motor_check.h"

#include <cmath>
#include <cstdio>

namespace gaitd::can {
namespace {

constexpr double kTolerance = 1e-4;  // of a range

std::string text_of(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.5g", value);
  return text;
}

}  // namespace

std::string check_registers(const MotorRegisters& registers, const Ranges& ranges,
                            double longest_timeout) {
  std::string errors;
  const auto add = [&errors](const std::string& text) {
    errors += (errors.empty() ? "" : "; ") + text;
  };
  const auto compare = [&add](const char* name, double expected, double real) {
    if (std::abs(real - expected) <= kTolerance * expected) return;  // not so for NaN
    add(std::string("expected ") + name + " " + text_of(expected) +
        " as robot.yaml says, the motor has " + text_of(real) + ": correct one of them");
  };
  compare("PMAX", ranges.position, registers.position_range);
  compare("VMAX", ranges.velocity, registers.velocity_range);
  compare("TMAX", ranges.torque, registers.torque_range);
  const double timeout = kTimeoutUnit * registers.timeout;
  if (registers.timeout == 0) {
    add("TIMEOUT is 0: without commands the motor would go on with the last one for ever; set "
        "register 9");
  } else if (timeout > longest_timeout) {
    add("expected a TIMEOUT of at most " + text_of(longest_timeout) + " s, the motor has " +
        text_of(timeout) + " s: lower register 9, or raise motor_timeout");
  }
  if (registers.control_mode != kMitControlMode) {
    add("expected CTRL_MODE 1 (MIT), the motor has " + std::to_string(registers.control_mode) +
        ": set register 10");
  }
  return errors;
}

}  // namespace gaitd::can
