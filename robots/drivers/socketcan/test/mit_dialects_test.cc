// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "codes.h"
#include "dialect.h"
#include "sensor_frames.h"

namespace gaitd::can {
namespace {

using Bytes = std::array<uint8_t, 8>;
const Ranges kMitRanges{12.5, 30.0, 10.0, 500.0, 5.0};
const MotorId kMitMotor{5, 0x15};

Frame command_of(const MotorCommand& command) {
  return kDamiao.command(kMitMotor, kMitRanges, command);
}

TEST(MitDialects, EveryCodeSurvivesARoundTrip) {
  const double ranges[] = {12.5, 3.141593, 95.5, 10.0, 54.0, 0.1};
  for (const double range : ranges) {
    for (uint32_t code = 0; code <= 0xFFFF; ++code) {
      ASSERT_EQ(code, to_code(from_code(code, -range, range, 16), -range, range, 16)) << range;
    }
    for (uint32_t code = 0; code <= 0xFFF; ++code) {
      ASSERT_EQ(code, to_code(from_code(code, -range, range, 12), -range, range, 12)) << range;
      ASSERT_EQ(code, to_code(from_code(code, 0, range, 12), 0, range, 12)) << range;
    }
  }
}

TEST(MitDialects, EveryCodeOfEveryFieldSurvivesInTheFrame) {
  for (uint32_t code = 0; code <= 0xFFFF; ++code) {
    MotorCommand command;
    command.position = from_code(code, -12.5, 12.5, 16);
    const uint32_t small = code & 0xFFF;
    command.velocity = from_code(small, -30, 30, 12);
    command.stiffness = from_code(small ^ 0xAAA, 0, 500, 12);
    command.damping = from_code(small ^ 0x555, 0, 5, 12);
    command.torque = from_code(0xFFF - small, -10, 10, 12);
    const Frame frame = command_of(command);
    const MotorCommand back = kDamiao.read_command(frame, kMitRanges).value();
    ASSERT_EQ(frame.data, command_of(back).data) << code;
    ASSERT_EQ(code, static_cast<uint32_t>(frame.data[0] << 8 | frame.data[1]));
    ASSERT_EQ(small, static_cast<uint32_t>(frame.data[2] << 4 | frame.data[3] >> 4));
    ASSERT_EQ(small ^ 0xAAA, static_cast<uint32_t>((frame.data[3] & 0xF) << 8 | frame.data[4]));
    ASSERT_EQ(small ^ 0x555, static_cast<uint32_t>(frame.data[5] << 4 | frame.data[6] >> 4));
    ASSERT_EQ(0xFFF - small, static_cast<uint32_t>((frame.data[6] & 0xF) << 8 | frame.data[7]));
    ASSERT_DOUBLE_EQ(back.position, command.position);
    ASSERT_DOUBLE_EQ(back.torque, command.torque);
  }
}

TEST(MitDialects, EveryCodeOfAReplySurvivesInEachDialect) {
  for (const Dialect* dialect : {&kDamiao, &kMiniCheetah, &kCubeMars}) {
    for (uint32_t code = 0; code <= 0xFFFF; ++code) {
      MotorReply reply;
      reply.error = 1;
      reply.position = from_code(code, -12.5, 12.5, 16);
      reply.velocity = from_code(code & 0xFFF, -30, 30, 12);
      reply.torque = from_code(code >> 4, -10, 10, 12);
      const Frame frame = dialect->reply(kMitMotor, kMitRanges, reply);
      ASSERT_FALSE(dialect->read_reply(frame, {6, 0x15}, kMitRanges)) << "of another motor";
      const auto back = dialect->read_reply(frame, kMitMotor, kMitRanges);
      ASSERT_TRUE(back) << code;
      ASSERT_EQ(back->error, 1);
      ASSERT_DOUBLE_EQ(back->position, reply.position);
      ASSERT_DOUBLE_EQ(back->velocity, reply.velocity);
      ASSERT_DOUBLE_EQ(back->torque, reply.torque);
    }
  }
}

TEST(MitDialects, ZeroIsAlmostTheMiddleAndNotAnAllZeroPayload) {
  const Bytes zero{0x7F, 0xFF, 0x7F, 0xF0, 0x00, 0x00, 0x07, 0xFF};
  EXPECT_EQ(zero, command_of({}).data);
  EXPECT_TRUE(kDamiao.is_torque_free(command_of({})));
  EXPECT_FALSE(kDamiao.is_torque_free(command_of({.torque = 0.01})));
  EXPECT_FALSE(kDamiao.is_torque_free(command_of({.velocity = 0.1})));
  EXPECT_FALSE(kDamiao.is_torque_free(command_of({.stiffness = 0.2})));
  Frame nothing;  // what a forgotten initialisation would send
  EXPECT_FALSE(kDamiao.is_torque_free(nothing));
  EXPECT_DOUBLE_EQ(-10.0, kDamiao.read_command(nothing, kMitRanges)->torque);
}

TEST(MitDialects, TheSafeIdleIsMiddleCodesWithASmallDamping) {
  const Bytes idle{0x7F, 0xFF, 0x7F, 0xF0, 0x00, 0x19, 0x97, 0xFF};
  EXPECT_EQ(idle, command_of({.damping = 0.5}).data);
  EXPECT_TRUE(kDamiao.is_torque_free(command_of({.damping = 0.5})));
}

TEST(MitDialects, PublishedExamples) {
  // p = PMAX, v = VMAX, kp = 500, kd = 5, t = TMAX: all ones.
  const Bytes ones{0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF};
  EXPECT_EQ(ones, command_of({12.5, 30, 500, 5, 10}).data);
  // Beyond the range is the end of the range, and what is no number is the middle.
  EXPECT_EQ(ones, command_of({99, 99, 999, 99, 99}).data);
  EXPECT_EQ(0x7FFFu, to_code(std::nan(""), -12.5, 12.5, 16));
  // Half of the gains.
  const Bytes gains{0x7F, 0xFF, 0x7F, 0xF7, 0xFF, 0x7F, 0xF7, 0xFF};
  EXPECT_EQ(gains, command_of({0, 0, 250, 2.5, 0}).data);
}

TEST(MitDialects, SpecialFrames) {
  const Bytes enable{0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFC};
  EXPECT_EQ(enable, kDamiao.special(kMitMotor, Special::kEnable).data);
  for (const Special s :
       {Special::kEnable, Special::kDisable, Special::kSetZero, Special::kClear}) {
    EXPECT_EQ(s, kDamiao.read_special(kDamiao.special(kMitMotor, s)));
  }
  EXPECT_FALSE(kDamiao.read_special(command_of({12.5, 30, 500, 5, 10})));
}

TEST(MitDialects, DamiaoReplyHasErrorAndTemperatures) {
  Frame frame;
  frame.id = 0x11;
  frame.data = {0xB1, 0x80, 0x00, 0x80, 0x08, 0x00, 65, 70};
  const MotorId motor{1, 0x11};
  const auto reply = kDamiao.read_reply(frame, motor, kMitRanges);
  ASSERT_TRUE(reply);
  EXPECT_STREQ("drive too hot", motor_error_text(reply->error));
  EXPECT_NEAR(0.0, reply->position, 2e-4);
  EXPECT_EQ(65, reply->mosfet_temperature);
  EXPECT_EQ(70, reply->rotor_temperature);
  frame.length = 7;
  frame.data[0] = 1;
  EXPECT_FALSE(kDamiao.read_reply(frame, motor, kMitRanges));
  EXPECT_TRUE(kMiniCheetah.read_reply(frame, motor, kMitRanges));
  frame.length = 12;
  EXPECT_FALSE(kDamiao.read_reply(frame, motor, kMitRanges));
  EXPECT_FALSE(kMiniCheetah.read_reply(frame, motor, kMitRanges));
}

TEST(MitDialects, RegistersOfDamiao) {
  const MotorId motor{0x104, 0x14};
  const Frame read = kDamiao.register_request(motor, 21);
  EXPECT_EQ(kDamiaoRegisterId, read.id);
  EXPECT_EQ((Bytes{0x04, 0x01, 0x33, 21, 0, 0, 0, 0}), read.data);
  EXPECT_EQ(0x104u, kDamiao.read_register_request(read)->motor);
  const Frame answer = kDamiao.register_answer(motor, {0x104, 21, raw_of(12.5f)});
  EXPECT_EQ((Bytes{0x04, 0x01, 0x33, 21, 0x00, 0x00, 0x48, 0x41}), answer.data);
  const auto value = kDamiao.read_register_answer(answer, motor);
  ASSERT_TRUE(value);
  EXPECT_EQ(21, value->address);
  EXPECT_FLOAT_EQ(12.5f, value->real());
  EXPECT_FALSE(kDamiao.read_register_answer(answer, {0x004, 0x14}));
  EXPECT_FALSE(kDamiao.read_register_answer(answer, {0x104, 0x15}));
  // What is about a register is no state, whether it was read or written.
  Frame written = answer;
  written.data[2] = 0x55;
  EXPECT_FALSE(kDamiao.read_reply(answer, motor, kMitRanges));
  EXPECT_FALSE(kDamiao.read_reply(written, motor, kMitRanges));
}

TEST(SensorFrames, EveryCodeSurvives) {
  for (int code = -32767; code <= 32767; ++code) {
    const double value[3] = {code * kForceUnit, -code * kForceUnit, 0};
    double back[3];
    EXPECT_EQ(code & 0xFFFF,
              decode_vector(encode_vector(1, value, kForceUnit, static_cast<uint16_t>(code)),
                            kForceUnit, back));
    ASSERT_DOUBLE_EQ(value[0], back[0]);
    ASSERT_DOUBLE_EQ(value[1], back[1]);
  }
  const double huge[3] = {1e9, -1e9, 0};
  double back[3];
  decode_vector(encode_vector(1, huge, kForceUnit, 0), kForceUnit, back);
  EXPECT_DOUBLE_EQ(32767 * kForceUnit, back[0]);
  EXPECT_DOUBLE_EQ(-32767 * kForceUnit, back[1]);
}

}  // namespace
}  // namespace gaitd::can
