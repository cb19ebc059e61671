// SPDX-License-Identifier: Apache-2.0
#include "motor_check.h"

#include <gtest/gtest.h>

#include <limits>

namespace gaitd::can {
namespace {

const Ranges kRanges{26, 100, 120, 500, 5};
const MotorRegisters kGood{26, 100, 120, 2000, kMitControlMode};

std::string errors_of(void (*change)(MotorRegisters*)) {
  MotorRegisters registers = kGood;
  change(&registers);
  return check_registers(registers, kRanges, 0.1);
}

TEST(MotorCheck, AcceptsWhatTheWiringSays) {
  EXPECT_EQ("", errors_of([](MotorRegisters*) {}));
}

TEST(MotorCheck, RefusesRangesThatDifferOrAreNoNumbers) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const float value : {kNaN, -kNaN, kInfinity, -kInfinity, 0.0f, -26.0f, 26.1f}) {
    MotorRegisters registers = kGood;
    registers.position_range = value;
    EXPECT_EQ(0u, check_registers(registers, kRanges, 0.1).find("expected PMAX 26")) << value;
    registers = kGood;
    registers.velocity_range = value;
    EXPECT_EQ(0u, check_registers(registers, kRanges, 0.1).find("expected VMAX 100")) << value;
    registers = kGood;
    registers.torque_range = value;
    EXPECT_EQ(0u, check_registers(registers, kRanges, 0.1).find("expected TMAX 120")) << value;
  }
}

TEST(MotorCheck, RefusesATimeoutThatIsNoneOrTooLongAndAnotherMode) {
  const auto has = [](const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
  };
  EXPECT_TRUE(has(errors_of([](MotorRegisters* r) { r->timeout = 0; }), "TIMEOUT is 0"));
  EXPECT_TRUE(has(errors_of([](MotorRegisters* r) { r->timeout = 2001; }), "at most 0.1 s"));
  EXPECT_TRUE(has(errors_of([](MotorRegisters* r) { r->timeout = 0xFFFFFFFF; }), "at most 0.1 s"));
  const std::string both = errors_of([](MotorRegisters* r) {
    r->timeout = 0;
    r->control_mode = 2;
  });
  EXPECT_TRUE(has(both, "TIMEOUT is 0") && has(both, "expected CTRL_MODE 1 (MIT)")) << both;
}

}  // namespace
}  // namespace gaitd::can
