// SPDX-License-Identifier: Apache-2.0
// A robot of one motor on slcan: what is on the wire, cycle by cycle.
#include <chrono>
#include <cmath>

#include "robot_bench.h"

namespace gaitd::can {
namespace {

TEST(CanRobot, IsSwitchedOnByTorqueOnlyAndOffAtTheEnd) {
  Bench b;
  EXPECT_EQ(0u, b.read());
  EXPECT_NEAR(-0.15, b.sensors.joints[0].position, 1e-3);
  EXPECT_EQ(1u, b.sensors.joints[0].info.valid);
  EXPECT_EQ(Special::kDisable, b.special_of(b.cycle(GAITD_JOINT_MODE_DAMPING)));
  EXPECT_EQ(Special::kDisable, b.special_of(b.cycle(GAITD_JOINT_MODE_OFF)));
  EXPECT_EQ(Special::kEnable, b.special_of(b.cycle(GAITD_JOINT_MODE_TORQUE, 4)));
  const MotorCommand command =
      b.dialect.read_command(b.cycle(GAITD_JOINT_MODE_TORQUE, 4), kRanges).value();
  EXPECT_NEAR(-2.0, command.torque, 0.01);
  EXPECT_NEAR(0.5, command.damping, 0.01);
  // Beyond the limit of the transmission.
  EXPECT_NEAR(-3.0, b.dialect.read_command(b.cycle(GAITD_JOINT_MODE_TORQUE, 400), kRanges)->torque,
              0.01);
  const Frame damped = b.cycle(GAITD_JOINT_MODE_DAMPING);
  EXPECT_TRUE(b.dialect.is_torque_free(damped));
  EXPECT_FALSE(b.special_of(damped));
  // Figures that are none never become torque.
  b.write(GAITD_JOINT_MODE_TORQUE, std::nan(""));
  EXPECT_TRUE(b.dialect.is_torque_free(b.wire.take().at(0)));
  b.robot->stop();
  const std::vector<Frame> last = b.wire.take();
  ASSERT_EQ(3u, last.size());
  for (const Frame& frame : last) EXPECT_EQ(Special::kDisable, b.special_of(frame));
}

TEST(CanRobot, SpeaksToRobStrideMotorsOnExtendedIdentifiers) {
  Kit kit;
  kit.dialect = &kRobStride;
  kit.sensors = true;
  Bench b(kit);
  b.wire.send(encode_estop(kEstopId, false, 1));
  b.wire.send(encode_estop(kEstopId, false, 2));
  EXPECT_EQ(0u, b.read());
  EXPECT_NEAR(-0.15, b.sensors.joints[0].position, 1e-3);
  EXPECT_EQ(Special::kDisable, b.special_of(b.cycle(GAITD_JOINT_MODE_DAMPING)));
  EXPECT_EQ(Special::kEnable, b.special_of(b.cycle(GAITD_JOINT_MODE_TORQUE, 4)));
  const Frame frame = b.cycle(GAITD_JOINT_MODE_TORQUE, 4);
  EXPECT_EQ(kExtended | 0x01000001, frame.id & 0xFF0000FF);
  EXPECT_NEAR(-2.0, b.dialect.read_command(frame, kRanges)->torque, 1e-3);
  // A fault that comes before the reply of the cycle is not lost with it.
  b.write(GAITD_JOINT_MODE_TORQUE, 4);
  b.wire.take();
  b.wire.send(kRobStride.fault(b.motor, MotorError::kOverVoltage));
  b.answer();
  EXPECT_EQ(uint32_t{GAITD_HEALTH_MOTOR}, b.read());
  EXPECT_STREQ("motor of knee0: over-voltage", b.health().text);
  b.write(GAITD_JOINT_MODE_TORQUE, 4);
  const std::vector<Frame> frames = b.wire.take();
  ASSERT_EQ(1u, frames.size());
  EXPECT_TRUE(b.special_of(frames[0]) == Special::kDisable ||
              b.special_of(frames[0]) == Special::kClear);
}

TEST(CanRobot, CountsRepliesThatAreMissingLateAndDuplicate) {
  Bench b;
  b.cycle(GAITD_JOINT_MODE_OFF);
  const GaitdHealth before = b.health();
  b.write(GAITD_JOINT_MODE_OFF, 0);
  b.read();
  EXPECT_EQ(before.missing + 1, b.health().missing);
  EXPECT_GT(b.sensors.joints[0].info.age, 0.01);
  b.answer();  // of the cycle before
  b.read();
  EXPECT_EQ(before.late + 1, b.health().late);
  b.answer();
  b.read();
  EXPECT_EQ(before.duplicate + 1, b.health().duplicate);
}

TEST(CanRobot, InLockstepTheEndOfAnEarlierCycleEndsNothing) {
  using Clock = std::chrono::steady_clock;
  Kit kit;
  kit.options.lockstep = true;
  kit.options.lockstep_timeout = 0.2;
  Bench b(kit);
  b.write(GAITD_JOINT_MODE_OFF, 0);
  b.wire.send(encode_end_of_cycle());  // of the cycle of the start, whose replies were enough
  const auto begin = Clock::now();
  b.robot->advance();
  EXPECT_GE(std::chrono::duration<double>(Clock::now() - begin).count(), 0.19);
}

TEST(CanRobot, AfterBusOffOnlySwitchesOffUntilTorqueIsCommandedAgain) {
  Bench b;
  b.cycle(GAITD_JOINT_MODE_TORQUE, 4);
  b.cycle(GAITD_JOINT_MODE_TORQUE, 4);
  b.wire.bus_off();
  EXPECT_EQ(uint32_t{GAITD_HEALTH_BUS}, b.read());
  // Nothing may wait in the queue but what switches off, whatever is commanded.
  for (int i = 0; i < 250; ++i) b.write(GAITD_JOINT_MODE_TORQUE, 4);
  EXPECT_EQ(uint32_t{GAITD_HEALTH_BUS}, b.read());
  b.wire.set_up(false);
  b.read();
  b.wire.set_up(true);
  for (int i = 0; i < 250; ++i) b.write(GAITD_JOINT_MODE_DAMPING, 0);
  const std::vector<Frame> frames = b.wire.take();
  EXPECT_FALSE(frames.empty());
  for (const Frame& frame : frames) EXPECT_EQ(Special::kDisable, b.special_of(frame));
  b.answer();
  EXPECT_EQ(0u, b.read());
  EXPECT_EQ(Special::kDisable, b.special_of(b.cycle(GAITD_JOINT_MODE_DAMPING)));
  EXPECT_EQ(Special::kEnable, b.special_of(b.cycle(GAITD_JOINT_MODE_TORQUE, 4)));
}

TEST(CanRobot, ErrorPassiveIsAWarningUntilTheBusIsActiveAgain) {
  Bench b;
  b.wire.say("sp128000");
  EXPECT_EQ(uint32_t{GAITD_HEALTH_WARNING}, b.read());
  b.wire.say("sa000000");
  EXPECT_EQ(0u, b.read());
}

TEST(CanRobot, ABusThatTakesNoCommandsForThreeCyclesIsAFaultAndNothingIsSentTwice) {
  Bench b;
  const auto unsent = [&] { return b.health().unsent; };
  b.cycle(GAITD_JOINT_MODE_TORQUE, 4);
  // Nobody reads the wire: first its buffer fills up, then the transmit queue.
  uint32_t cycles = 0;
  for (; b.read() == 0 && cycles < 100'000; ++cycles) {
    EXPECT_LT(unsent(), 3u);
    b.write(GAITD_JOINT_MODE_TORQUE, 4);
  }
  EXPECT_EQ(uint32_t{GAITD_HEALTH_BUS}, b.read());
  EXPECT_EQ(3u, unsent());
  EXPECT_EQ(cycles - unsent(), b.wire.take().size());
  b.write(GAITD_JOINT_MODE_DAMPING, 0);
  EXPECT_EQ(0u, b.read());
  EXPECT_EQ(1u, b.wire.take().size());
}

TEST(CanRobot, ABusThatFellAndCameBackBetweenTwoReadsIsToldAndItsMotorsStayOff) {
  Bench b;
  b.cycle(GAITD_JOINT_MODE_TORQUE, 4);
  b.cycle(GAITD_JOINT_MODE_TORQUE, 4);
  b.wire.set_up(false);
  b.write(GAITD_JOINT_MODE_TORQUE, 4);  // hears of it
  b.wire.set_up(true);
  b.answer();
  EXPECT_EQ(uint32_t{GAITD_HEALTH_BUS}, b.read());
  // The daemon has latched its fault by now.
  EXPECT_EQ(Special::kDisable, b.special_of(b.cycle(GAITD_JOINT_MODE_DAMPING)));
}

}  // namespace
}  // namespace gaitd::can
