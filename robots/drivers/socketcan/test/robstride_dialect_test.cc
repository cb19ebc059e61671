// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "codes.h"
#include "dialect.h"

namespace gaitd::can {
namespace {

using Bytes = std::array<uint8_t, 8>;
constexpr double kTurns = 12.566370614359172;              // rad, +-
const Ranges kRobstrideRanges{kTurns, 20, 60, 5000, 100};  // of an RS03
const MotorId kRobstrideMotor{1, 0xFD};

uint8_t error_of(uint32_t id) {
  Frame frame;
  frame.id = kExtended | id;
  const auto reply = kRobStride.read_reply(frame, kRobstrideMotor, kRobstrideRanges);
  return reply ? reply->error : 0xFF;
}

TEST(RobStride, EveryCodeSurvives) {
  for (uint32_t code = 0; code <= 0xFFFF; ++code) {
    const auto value = [code](double range) { return from_code(code, -range, range, 16); };
    MotorCommand command;
    command.position = value(kTurns);
    command.velocity = value(20);
    command.torque = value(60);
    command.stiffness = from_code(code, 0, 5000, 16);
    command.damping = from_code(code, 0, 100, 16);
    const Frame frame = kRobStride.command(kRobstrideMotor, kRobstrideRanges, command);
    ASSERT_EQ(kExtended | 0x01000001 | code << 8, frame.id);
    for (int i = 0; i < 4; ++i) {
      ASSERT_EQ(code, static_cast<uint32_t>(frame.data[2 * i] << 8 | frame.data[2 * i + 1]));
    }
    const auto back = kRobStride.read_command(frame, kRobstrideRanges);
    ASSERT_TRUE(back);
    ASSERT_DOUBLE_EQ(command.torque, back->torque);
    ASSERT_DOUBLE_EQ(command.damping, back->damping);
  }
}

// The frames that the manual gives: enable and stop a motor, set its zero, read a value.
TEST(RobStride, PublishedFrames) {
  const MotorId motor{0x7F, 0xFD};
  EXPECT_EQ(kExtended | 0x0300FD7F, kRobStride.special(motor, Special::kEnable).id);
  EXPECT_EQ(kExtended | 0x0400FD7F, kRobStride.special(motor, Special::kDisable).id);
  EXPECT_EQ(Bytes{}, kRobStride.special(motor, Special::kDisable).data);
  EXPECT_EQ((Bytes{1}), kRobStride.special(motor, Special::kClear).data);
  EXPECT_EQ(kExtended | 0x0600FD7F, kRobStride.special(motor, Special::kSetZero).id);
  const Frame read = kRobStride.register_request(motor, 0x7028);
  EXPECT_EQ(kExtended | 0x1100FD7F, read.id);
  EXPECT_EQ((Bytes{0x28, 0x70}), read.data);
}

TEST(RobStride, AReplyTellsModeAndFaultsInItsIdentifier) {
  EXPECT_EQ(static_cast<uint8_t>(MotorError::kOff), error_of(0x020001FD));
  EXPECT_EQ(static_cast<uint8_t>(MotorError::kOn), error_of(0x028001FD));
  EXPECT_STREQ("encoder not calibrated", motor_error_text(error_of(0x024001FD)));
  const char* faults[] = {"under-voltage", "over-current", "rotor too hot",
                          "encoder fault", "overload",     "encoder not calibrated"};
  for (int i = 0; i < 6; ++i) {
    // Whatever the mode says.
    EXPECT_STREQ(faults[i], motor_error_text(error_of(0x028001FD | 1u << (16 + i))));
    EXPECT_STREQ(faults[i], motor_error_text(error_of(0x020001FD | 1u << (16 + i))));
  }
  EXPECT_EQ(0xFF, error_of(0x028002FD)) << "another motor";
  EXPECT_EQ(0xFF, error_of(0x028001FE)) << "another master";
  EXPECT_EQ(0xFF, error_of(0x118001FD)) << "an answer about a register";
}

TEST(RobStride, AReplyHasItsTemperatureInTenths) {
  Frame frame;
  frame.id = kExtended | 0x028001FD;
  frame.data = {0xFF, 0xFF, 0x80, 0x00, 0x00, 0x00, 0x01, 0xC2};
  const auto reply = kRobStride.read_reply(frame, kRobstrideMotor, kRobstrideRanges);
  ASSERT_TRUE(reply);
  EXPECT_DOUBLE_EQ(kTurns, reply->position);
  EXPECT_NEAR(0.0, reply->velocity, 4e-4);
  EXPECT_DOUBLE_EQ(-60, reply->torque);
  EXPECT_EQ(45, reply->rotor_temperature);
}

TEST(RobStride, AFaultFrameNamesItsFaultAndWarningsAreNone) {
  for (const MotorError error :
       {MotorError::kOverVoltage, MotorError::kRotorHot, MotorError::kOverCurrent,
        MotorError::kOverload, MotorError::kDriveFault}) {
    const Frame frame = kRobStride.fault(kRobstrideMotor, error);
    EXPECT_EQ(error, kRobStride.read_fault(frame, kRobstrideMotor));
    EXPECT_FALSE(kRobStride.read_fault(frame, {2, 0xFD}));
    EXPECT_FALSE(kRobStride.read_reply(frame, kRobstrideMotor, kRobstrideRanges));
  }
  Frame phase;
  phase.id = kExtended | 0x150001FD;
  phase.data[2] = 1;
  EXPECT_EQ(MotorError::kOverCurrent, kRobStride.read_fault(phase, kRobstrideMotor));
  Frame unknown;
  unknown.id = phase.id;
  unknown.data[3] = 0x80;
  EXPECT_EQ(MotorError::kDriveFault, kRobStride.read_fault(unknown, kRobstrideMotor));
  Frame warning;
  warning.id = kExtended | 0x150001FD;
  warning.data[4] = 1;
  EXPECT_EQ(MotorError::kOn, kRobStride.read_fault(warning, kRobstrideMotor));
}

TEST(RobStride, ARegisterThatTheMotorDoesNotHaveIsSaidSo) {
  const auto value = kRobStride.read_register_answer(
      kRobStride.register_answer(kRobstrideMotor, {1, 0x7028, 0, false}), kRobstrideMotor);
  ASSERT_TRUE(value);
  EXPECT_FALSE(value->known);
}

}  // namespace
}  // namespace gaitd::can
