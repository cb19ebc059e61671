// SPDX-License-Identifier: Apache-2.0
#include "motor_errors.h"

namespace gaitd::unitree {
namespace {

struct Error {
  uint32_t bit;
  const char* text;
};

constexpr Error kErrors[] = {
    {0x80000000u, "the robot's computer lost it"},
    {0x40000000u, "it lost the robot's computer"},
    {0x1, "overcurrent"},
    {0x2, "overvoltage"},
    {0x4, "lasting overvoltage"},
    {0x8, "undervoltage"},
    {0x200, "winding too hot"},
    {0x20, "power stage too hot or too cold"},
    {0x80, "case too hot or too cold"},
    {0x10, "chip too hot"},
    {0x400, "rotor encoder 1"},
    {0x800, "rotor encoder 2"},
    {0x1000, "output encoder"},
    {0x2000, "calibration data"},
    {0x8000, "locked"},
    {0x4000, "it was reset"},
    {0x10000, "check of its chip"},
    {0x20000, "it is being calibrated"},
    {0x40000, "check of its bus"},
    {0x80000, "old driver"},
    {0x40, "sensor of the power stage's temperature"},
    {0x100, "sensor of the case's temperature"},
};

}  // namespace

const char* motor_error_text(uint32_t bits) {
  if (bits == 0) return "";
  for (const Error& error : kErrors) {
    if ((bits & error.bit) != 0) return error.text;
  }
  return "an error that is not documented";
}

}  // namespace gaitd::unitree
