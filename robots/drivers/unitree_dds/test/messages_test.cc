// SPDX-License-Identifier: Apache-2.0
// What is in the bytes: CRC, packing, the remote, the order of the joints.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "crc.h"
#include "motor_errors.h"
#include "motor_target.h"
#include "packing.h"
#include "remote.h"

namespace gaitd::unitree {
namespace {

template <class Message>
Message zero() {
  Message message;
  std::memset(&message, 0, sizeof(message));
  return message;
}

TEST(Crc, IsCrc32Mpeg2OverWordsFromTheirMostSignificantByte) {
  const uint8_t text[12] = {'4', '3', '2', '1', '8', '7', '6', '5'};
  EXPECT_EQ(0x0376E6E7u ^ 0, [] {
    // The check value is of nine bytes, which are no words: bit by bit here.
    uint32_t crc = 0xFFFFFFFFu;
    for (const char c : std::string("123456789")) {
      crc ^= static_cast<uint32_t>(c) << 24;
      for (int bit = 0; bit < 8; ++bit) {
        crc = (crc & 0x80000000u) != 0 ? (crc << 1) ^ 0x04C11DB7u : crc << 1;
      }
    }
    return crc;
  }());
  uint32_t expected = 0xFFFFFFFFu;
  for (const char c : std::string("12345678")) {
    expected ^= static_cast<uint32_t>(c) << 24;
    for (int bit = 0; bit < 8; ++bit) {
      expected = (expected & 0x80000000u) != 0 ? (expected << 1) ^ 0x04C11DB7u : expected << 1;
    }
  }
  EXPECT_EQ(expected, crc32(text, 2));
}

// Published values; the third one is of the maker's own library.
TEST(Crc, OfCommandsIsThatOfTheMaker) {
  EXPECT_EQ(0xFE172F9Fu, message_crc(zero<LowCmd>()));
  LowCmd on = zero<LowCmd>();
  on.mode_machine = 5;
  for (int i = 0; i < 29; ++i) on.motor_cmd[i].mode = 1;
  EXPECT_EQ(0x058980D1u, message_crc(on));
  LowCmd two = zero<LowCmd>();
  two.motor_cmd[3].q = 0.5f;
  two.motor_cmd[15].q = 0.2f;
  for (const int i : {3, 15}) {
    two.motor_cmd[i].kp = 25;
    two.motor_cmd[i].kd = 0.5f;
  }
  EXPECT_EQ(4030115248u, message_crc(two));
}

TEST(Crc, OfStatesIsThatOfTheMaker) {
  EXPECT_EQ(0xD64BB04Au, message_crc(zero<LowState>()));
  LowState state = zero<LowState>();
  state.mode_machine = 5;
  state.tick = 1000;
  state.imu_state.quaternion[0] = 1;
  for (int i = 0; i < 29; ++i) {
    state.motor_state[i].mode = 1;
    state.motor_state[i].q = 0.1f * static_cast<float>(i);
  }
  EXPECT_EQ(0x2C34AE00u, message_crc(state));
}

Command driving() {
  Command command{};
  command.driven = 1;
  for (MotorTarget& motor : command.motors) motor = {Drive::kDrive, 0.1f, 0.2f, 3, 40, 2};
  return command;
}

TEST(Pack, DrivesDampsAndLeavesOff) {
  Command command = driving();
  command.motors[1].drive = Drive::kDamp;
  command.motors[2].drive = Drive::kOff;
  float measured[kMotors] = {};
  measured[1] = -0.7f;
  const LowCmd message = pack(command, ~uint64_t{0}, measured, 5);
  EXPECT_EQ(0, message.mode_pr);
  EXPECT_EQ(5, message.mode_machine);
  const MotorCmd& driven = message.motor_cmd[0];
  EXPECT_EQ(1, driven.mode);
  EXPECT_EQ(0.1f, driven.q);
  EXPECT_EQ(0.2f, driven.dq);
  EXPECT_EQ(3.0f, driven.tau);
  EXPECT_EQ(40.0f, driven.kp);
  EXPECT_EQ(2.0f, driven.kd);
  const MotorCmd& damped = message.motor_cmd[1];
  EXPECT_EQ(1, damped.mode);
  EXPECT_EQ(-0.7f, damped.q);  // where it is
  EXPECT_EQ(0.0f, damped.dq);
  EXPECT_EQ(0.0f, damped.tau);
  EXPECT_EQ(0.0f, damped.kp);
  EXPECT_EQ(2.0f, damped.kd);
  for (const int i : {2, 29, 34}) {
    EXPECT_EQ(0, message.motor_cmd[i].mode) << i;
    EXPECT_EQ(0.0f, message.motor_cmd[i].kd) << i;
  }
  EXPECT_EQ(message_crc(message), message.crc);
  for (const uint32_t word : message.reserve) EXPECT_EQ(0u, word);
}

TEST(Pack, LeavesMotorsOffThatAVariantLacks) {
  const float measured[kMotors] = {};
  const LowCmd message = pack(driving(), ~find_variant(6)->missing, measured, 6);
  EXPECT_EQ(1, message.motor_cmd[12].mode);
  EXPECT_EQ(0, message.motor_cmd[13].mode);
  EXPECT_EQ(0, message.motor_cmd[14].mode);
}

TEST(Pack, SaysWhichStateItAnswersInLockstepOnly) {
  Command command = driving();
  const float measured[kMotors] = {};
  EXPECT_EQ(0u, cycle_of(pack(command, ~uint64_t{0}, measured, 5)));
  command.cycle = 77;
  const LowCmd message = pack(command, ~uint64_t{0}, measured, 5);
  EXPECT_EQ(77u, cycle_of(message));
  EXPECT_EQ(message_crc(message), message.crc);
}

TEST(Joints, StandInTheOrderOfTheWire) {
  EXPECT_EQ(0, wire_index("left_hip_pitch_joint"));
  EXPECT_EQ(4, wire_index("left_ankle_pitch_joint"));
  EXPECT_EQ(5, wire_index("left_ankle_roll_joint"));
  EXPECT_EQ(9, wire_index("right_knee_joint"));
  EXPECT_EQ(13, wire_index("waist_roll_joint"));
  EXPECT_EQ(14, wire_index("waist_pitch_joint"));
  EXPECT_EQ(28, wire_index("right_wrist_yaw_joint"));
  EXPECT_EQ(-1, wire_index("l_leg_kny"));
}

TEST(Joints, VariantsSayWhatTheyLack) {
  EXPECT_EQ(0u, find_variant(5)->missing);
  EXPECT_EQ((uint64_t{1} << 13) | (uint64_t{1} << 14), find_variant(16)->missing);
  EXPECT_NE(0u, find_variant(4)->missing >> 27 & 1);
  EXPECT_EQ(nullptr, find_variant(0));
  EXPECT_EQ(nullptr, find_variant(7));
  EXPECT_STREQ("", find_variant(5)->warning);
  EXPECT_STRNE("", find_variant(15)->warning);
}

TEST(Remote, AsksForDampingByThreeCombinations) {
  uint8_t bytes[kRemoteBytes] = {};
  EXPECT_EQ(nullptr, estop_keys(keys_of(bytes)));
  bytes[2] = 1 << 5;  // L2 alone
  EXPECT_EQ(nullptr, estop_keys(keys_of(bytes)));
  bytes[3] = 1 << 1;  // and B
  EXPECT_STREQ("L2+B", estop_keys(keys_of(bytes)));
  bytes[2] |= 1 << 4;  // whatever else
  EXPECT_STREQ("L2+B", estop_keys(keys_of(bytes)));
  bytes[2] = 1 << 1;
  bytes[3] = 1 << 0;
  EXPECT_STREQ("L1+A", estop_keys(keys_of(bytes)));
  bytes[2] = 1 << 3;
  bytes[3] = 0;
  EXPECT_STREQ("select", estop_keys(keys_of(bytes)));
  // The sticks are not keys.
  std::memset(bytes + 4, 0xFF, sizeof(bytes) - 4);
  bytes[2] = 0;
  EXPECT_EQ(nullptr, estop_keys(keys_of(bytes)));
}

TEST(MotorErrors, AreToldInWords) {
  EXPECT_STREQ("", motor_error_text(0));
  EXPECT_STREQ("winding too hot", motor_error_text(0x200));
  EXPECT_STREQ("it lost the robot's computer", motor_error_text(0x40000001));
  EXPECT_STREQ("an error that is not documented", motor_error_text(0x100000));
}

TEST(MotorTarget, StaysInsideTheLimitsOfJointAndSettings) {
  GaitdJoint joint{};
  joint.position_min = -1;
  joint.position_max = 0.5;
  joint.velocity_limit = 10;
  joint.effort_limit = 50;
  Settings settings;
  GaitdJointCommand c{};
  c.mode = GAITD_JOINT_MODE_TORQUE;
  c.torque = -80;
  c.position = 2;
  c.velocity = 30;
  c.stiffness = 9000;
  c.damping = 90;
  const MotorTarget target = motor_target(c, joint, settings);
  EXPECT_EQ(Drive::kDrive, target.drive);
  EXPECT_EQ(-50.0f, target.torque);
  EXPECT_EQ(0.5f, target.position);
  EXPECT_EQ(10.0f, target.velocity);
  EXPECT_EQ(500.0f, target.stiffness);
  EXPECT_EQ(20.0f, target.damping);
  c.mode = GAITD_JOINT_MODE_DAMPING;
  EXPECT_EQ(Drive::kDamp, motor_target(c, joint, settings).drive);
  EXPECT_EQ(0.0f, motor_target(c, joint, settings).torque);
  c.mode = GAITD_JOINT_MODE_OFF;
  EXPECT_EQ(Drive::kOff, motor_target(c, joint, settings).drive);
}

TEST(MotorTarget, DampsWhereAFigureIsNone) {
  GaitdJoint joint{};
  joint.effort_limit = 50;
  const Settings settings;
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  for (double GaitdJointCommand::*figure :
       {&GaitdJointCommand::torque, &GaitdJointCommand::position, &GaitdJointCommand::velocity,
        &GaitdJointCommand::stiffness, &GaitdJointCommand::damping}) {
    GaitdJointCommand c{};
    c.mode = GAITD_JOINT_MODE_TORQUE;
    c.torque = 20;
    c.damping = 3;
    c.*figure = kNaN;
    const MotorTarget target = motor_target(c, joint, settings);
    EXPECT_EQ(Drive::kDamp, target.drive);
    EXPECT_EQ(0.0f, target.torque);
    EXPECT_TRUE(std::isfinite(target.damping) && target.damping > 0);
  }
}

}  // namespace
}  // namespace gaitd::unitree
