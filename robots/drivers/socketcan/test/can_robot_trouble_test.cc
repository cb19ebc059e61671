// SPDX-License-Identifier: Apache-2.0
// A robot on slcan with clocks that jump, senders that repeat themselves and buses that take
// nothing.
#include <time.h>

#include <cmath>
#include <iterator>
#include <random>

#include "robot_bench.h"

namespace gaitd::can {
namespace {

// Sets the wall clock of this machine, which is the test's own.
void step_wall_clock(double seconds) {
  timespec t;
  clock_gettime(CLOCK_REALTIME, &t);
  const int64_t ns =
      int64_t{1'000'000'000} * t.tv_sec + t.tv_nsec + static_cast<int64_t>(1e9 * seconds);
  t = {static_cast<time_t>(ns / 1'000'000'000), static_cast<long>(ns % 1'000'000'000)};
  ASSERT_EQ(0, clock_settime(CLOCK_REALTIME, &t));
}

TEST(CanRobot, AStepOfTheWallClockMakesNoSensorStaleOrFresh) {
  Kit kit;
  kit.sensors = true;
  Bench b(kit);
  uint16_t counter = 0;
  for (const double step : {0.0, 3600.0, -3600.0, 0.5, -0.5, 1e8, -1e8}) {
    const int64_t begin = b.clocks.monotonic_ns();
    b.read();
    const uint32_t before = b.sensors.joints[0].info.sequence;
    b.answer();
    b.wire.send(encode_vector(kImuId, {1, 2, 3}, 1, ++counter));
    step_wall_clock(step);
    b.wire.send(encode_vector(kImuId + 1, {1, 2, 3}, 1, counter));
    b.read();
    const double passed = 1e-9 * static_cast<double>(b.clocks.monotonic_ns() - begin);
    for (const GaitdSignalInfo& info : {b.sensors.joints[0].info, b.sensors.imus[0].info}) {
      EXPECT_EQ(1u, info.valid);
      EXPECT_GE(info.age, 0.0) << step;
      EXPECT_LE(info.age, passed) << step;
    }
    EXPECT_EQ(before + 1, b.sensors.joints[0].info.sequence) << step;
    EXPECT_EQ(counter, b.sensors.imus[0].info.sequence) << step;
  }
}

TEST(CanRobot, FramesThatWaitedWhileItWasStoppedHaveTheirTrueAge) {
  Kit kit;
  kit.sensors = true;
  Bench b(kit);
  b.wire.send(encode_estop(kEstopId, false, 1));
  b.wire.send(encode_estop(kEstopId, false, 2));
  b.answer();
  EXPECT_EQ(0u, b.read());
  b.answer();
  b.wire.send(encode_estop(kEstopId, false, 3));
  b.clocks.passed += 200'000'000'000;
  EXPECT_EQ(uint32_t{GAITD_HEALTH_HEARTBEAT}, b.read()) << "the e-stop spoke 200 s ago";
  EXPECT_GT(b.sensors.joints[0].info.age, 200.0);
  EXPECT_LT(b.sensors.joints[0].info.age, 300.0);
}

TEST(CanRobot, TheEstopHasToBeHeardAndToCount) {
  Kit kit;
  kit.sensors = true;
  Bench b(kit);
  const auto say = [&](bool pressed, uint8_t counter) {
    b.wire.send(encode_estop(kEstopId, pressed, counter));
  };
  EXPECT_EQ(uint32_t{GAITD_HEALTH_HEARTBEAT}, b.read());
  EXPECT_STREQ("the e-stop was never heard", b.health().text);
  say(false, 1);
  EXPECT_EQ(uint32_t{GAITD_HEALTH_HEARTBEAT}, b.read());
  say(false, 2);
  EXPECT_EQ(0u, b.read());
  b.clocks.passed += 101'000'000'000;
  EXPECT_EQ(uint32_t{GAITD_HEALTH_HEARTBEAT}, b.read());
  EXPECT_STREQ("the e-stop is silent", b.health().text);
  say(false, 2);
  EXPECT_EQ(uint32_t{GAITD_HEALTH_HEARTBEAT}, b.read());
  EXPECT_STREQ("the e-stop repeats itself: its counter stands still", b.health().text);
  say(false, 3);
  EXPECT_EQ(0u, b.read());
  say(true, 4);
  say(false, 5);
  EXPECT_EQ(uint32_t{GAITD_HEALTH_ESTOP}, b.read()) << "pressed shortly";
  EXPECT_EQ(0u, b.read());
  const uint32_t bad = b.health().stale;
  Frame frame = encode_estop(kEstopId, false, 6);
  frame.length = 1;
  b.wire.send(frame);
  EXPECT_EQ(uint32_t{GAITD_HEALTH_ESTOP}, b.read());
  EXPECT_EQ(bad + 1, b.health().stale);
}

TEST(CanRobot, SamplesThatRepeatThemselvesOrAreMalformedAreCountedAndNotUsed) {
  Kit kit;
  kit.sensors = true;
  Bench b(kit);
  const auto send = [&](double value, uint16_t counter, int cut) {
    for (uint32_t i = 0; i < 2; ++i) {
      Frame frame = encode_vector(kImuId + i, {value, 0, 0}, kRateUnit, counter);
      frame.length = static_cast<uint8_t>(8 - cut);
      b.wire.send(frame);
    }
    b.read();
  };
  b.read();
  EXPECT_EQ(0u, b.sensors.imus[0].info.valid);
  send(1, 1, 0);
  EXPECT_EQ(1u, b.sensors.imus[0].info.valid);
  const GaitdHealth before = b.health();
  send(2, 1, 0);
  EXPECT_EQ(before.duplicate + 2, b.health().duplicate);
  send(3, 2, 1);
  EXPECT_EQ(before.stale + 2, b.health().stale);
  EXPECT_EQ(1u, b.sensors.imus[0].info.sequence);
  EXPECT_NEAR(1.0, b.sensors.imus[0].angular_rate[0], 1e-3);
  send(4, 2, 0);
  EXPECT_EQ(2u, b.sensors.imus[0].info.sequence);
}

TEST(CanRobot, WhateverIsOnTheBusIsReadToFiguresInRangeAndNeverToTorque) {
  Kit kit;
  kit.sensors = true;
  Bench b(kit);
  std::mt19937 random(1);
  constexpr uint32_t kIds[] = {0, kReplyId, kImuId, kImuId + 1, kEstopId, 0x7F0, 0x7FF};
  constexpr unsigned kBytes[] = {0x00, 0x01, 0x55, 0xFF};
  for (int round = 0; round < 50; ++round) {
    std::string text;
    for (int i = 0; i < 60; ++i) {
      const int length = static_cast<int>(random() % 9);
      char piece[16];
      std::snprintf(piece, sizeof(piece), "%st%03X%d", text.empty() ? "" : "\r",
                    kIds[random() % std::size(kIds)], length);
      text += piece;
      for (int k = 0; k < length; ++k) {
        std::snprintf(piece, sizeof(piece), "%02X", kBytes[random() % std::size(kBytes)]);
        text += piece;
      }
    }
    b.write(GAITD_JOINT_MODE_DAMPING, 0);
    b.wire.say(text);
    b.read();
    const GaitdJointSensor& joint = b.sensors.joints[0];
    EXPECT_GE(joint.info.age, 0.0);
    EXPECT_LE(std::abs(joint.position), kRanges.position);
    EXPECT_LE(std::abs(joint.velocity), kRanges.velocity);
    for (const double rate : b.sensors.imus[0].angular_rate) EXPECT_LE(std::abs(rate), 33.0);
  }
  EXPECT_GT(b.health().stale, 100u);
  for (const Frame& frame : b.wire.take()) {
    EXPECT_EQ(Special::kDisable, b.special_of(frame));
  }
}

TEST(CanRobot, AnAnswerAboutARegisterIsNoStateOfTheMotor) {
  Kit kit;
  kit.dialect = &kDamiao;
  Bench b(kit);
  b.read();
  const double position = b.sensors.joints[0].position;
  const uint32_t sequence = b.sensors.joints[0].info.sequence;
  const uint32_t stale = b.health().stale;
  // Somebody else asks the motor.
  b.wire.send(kDamiao.register_answer(b.motor, {1, 7, kReplyId}));
  b.read();
  EXPECT_EQ(position, b.sensors.joints[0].position);
  EXPECT_EQ(sequence, b.sensors.joints[0].info.sequence);
  EXPECT_EQ(stale + 1, b.health().stale);
}

TEST(CanRobot, StopsTheMotorsThatItReachesWithoutWaitingForABusThatIsDown) {
  Kit kit;
  kit.buses = 2;
  Bench b(kit);
  b.write(GAITD_JOINT_MODE_TORQUE, 4);
  b.wires[0]->take();
  b.wires[1]->take();
  b.wires[0]->set_up(false);
  int slept = 0;
  b.clocks.stopped = b.clocks.monotonic_ns();
  b.clocks.while_asleep = [&] { ++slept; };
  b.lines.clear();
  b.robot->stop();
  const std::vector<Frame> frames = b.wires[1]->take();
  EXPECT_EQ(3u, frames.size());
  for (const Frame& frame : frames) EXPECT_EQ(Special::kDisable, b.special_of(frame));
  EXPECT_LE(slept, 50) << "0.1 s";
  ASSERT_FALSE(b.lines.empty());
  EXPECT_NE(std::string::npos, b.lines[0].find("bus leg0")) << b.lines[0];
}

TEST(CanRobot, StopsTheMotorsOfABusWhoseQueueIsFullAsSoonAsItTakesFrames) {
  Bench b;
  b.cycle(GAITD_JOINT_MODE_TORQUE, 4);
  // Nobody reads the wire.
  for (int i = 0; b.read() == 0 && i < 100'000; ++i) b.write(GAITD_JOINT_MODE_TORQUE, 4);
  EXPECT_EQ(uint32_t{GAITD_HEALTH_BUS}, b.read());
  int slept = 0;
  std::vector<Frame> frames;
  b.clocks.stopped = b.clocks.monotonic_ns();
  b.clocks.while_asleep = [&] {
    if (++slept < 10) return;
    for (const Frame& frame : b.wire.take()) frames.push_back(frame);
  };
  b.robot->stop();
  for (const Frame& frame : b.wire.take()) frames.push_back(frame);
  ASSERT_GT(frames.size(), 3u);
  for (size_t i = frames.size() - 3; i < frames.size(); ++i) {
    EXPECT_EQ(Special::kDisable, b.special_of(frames[i]));
  }
  EXPECT_LE(slept, 50);
}

TEST(CanRobot, ASecondOneOnTheSameBusIsRefusedAndSwitchesNothingOff) {
  Bench bench;
  bench.wire.take();
  std::vector<std::string> errors;
  {
    RobotOptions options;
    options.clocks = &bench.clocks;
    CanRobot second(bench.wiring, bench.model, options, [](int, const std::string&) {});
    EXPECT_FALSE(second.start(&errors));
  }
  ASSERT_EQ(errors.size(), 1);
  EXPECT_NE(errors[0].find("another process commands its motors"), std::string::npos) << errors[0];
  EXPECT_TRUE(bench.wire.take().empty());
}

TEST(CanRobot, GivesUpOnABusThatTakesNothingAndSaysSo) {
  Bench b;
  b.cycle(GAITD_JOINT_MODE_TORQUE, 4);
  for (int i = 0; b.read() == 0 && i < 100'000; ++i) b.write(GAITD_JOINT_MODE_TORQUE, 4);
  int slept = 0;
  b.clocks.stopped = b.clocks.monotonic_ns();
  b.clocks.while_asleep = [&] { ++slept; };
  b.lines.clear();
  b.robot->stop();
  EXPECT_LE(slept, 50);
  ASSERT_FALSE(b.lines.empty());
  EXPECT_NE(std::string::npos, b.lines[0].find("does not take the frames")) << b.lines[0];
}

}  // namespace
}  // namespace gaitd::can
