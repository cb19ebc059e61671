// SPDX-License-Identifier: Apache-2.0
// A robot of one mini-cheetah motor on slcan: what is on the wire, cycle by cycle.
#include "can_robot.h"

#include <chrono>
#include <cmath>
#include <thread>

#include "sensor_frames.h"
#include "slcan.h"

namespace gaitd::can {
namespace {

const Ranges kRanges{12.5, 30, 10, 500, 5};

struct Bench {
  Slcan wire;
  GaitdModel model{};
  std::unique_ptr<CanRobot> robot;
  GaitdSensors sensors{};
  double position = 0.3;  // rad, that the motor shows

  explicit Bench(const RobotOptions& options = {}) {
    model.joint_count = 1;
    std::strcpy(model.joints[0].name, "knee");
    Wiring wiring;
    wiring.buses.push_back({"leg", wire.name(), {}});
    Motor motor;
    motor.id = 1;
    motor.dialect = Dialect::kMiniCheetah;
    motor.ranges = kRanges;
    motor.sign = -1;
    motor.gear = 2;
    motor.torque_limit = 6;
    motor.velocity_limit = 10;
    motor.position_min = -1;
    motor.position_max = 1;
    wiring.motors.push_back(motor);
    robot = std::make_unique<CanRobot>(wiring, model, options, [](int, const std::string&) {});
    std::vector<std::string> errors;
    std::thread starting([&] { EXPECT_TRUE(robot->start(&errors)); });
    while (wire.take().empty()) {
    }
    answer();
    starting.join();
  }
  void answer() {
    MotorReply reply;
    reply.motor = 1;
    reply.position = position;
    wire.send(encode_reply(0, reply, Dialect::kMiniCheetah, kRanges));
  }
  uint32_t read() {
    robot->read(&sensors);
    GaitdHealth health;
    robot->health(&health);
    return health.conditions;
  }
  void write(int mode, double torque) {
    GaitdJointCommands commands{};
    commands.joint_count = 1;
    commands.joints[0].mode = mode;
    commands.joints[0].torque = torque;
    commands.joints[0].damping = 2;
    robot->write(commands);
  }
  // The one frame of a cycle.
  Frame cycle(int mode, double torque = 0) {
    write(mode, torque);
    const std::vector<Frame> frames = wire.take();
    EXPECT_EQ(1u, frames.size());
    answer();
    EXPECT_EQ(0u, read());
    return frames.empty() ? Frame{} : frames[0];
  }
};

TEST(CanRobot, IsSwitchedOnByTorqueOnlyAndOffAtTheEnd) {
  Bench b;
  EXPECT_EQ(0u, b.read());
  EXPECT_NEAR(-0.15, b.sensors.joints[0].position, 1e-3);
  EXPECT_EQ(1u, b.sensors.joints[0].info.valid);
  EXPECT_EQ(Special::kDisable, decode_special(b.cycle(GAITD_JOINT_MODE_DAMPING)));
  EXPECT_EQ(Special::kDisable, decode_special(b.cycle(GAITD_JOINT_MODE_OFF)));
  EXPECT_EQ(Special::kEnable, decode_special(b.cycle(GAITD_JOINT_MODE_TORQUE, 4)));
  const MotorCommand command = decode_command(b.cycle(GAITD_JOINT_MODE_TORQUE, 4), kRanges);
  EXPECT_NEAR(-2.0, command.torque, 0.01);
  EXPECT_NEAR(0.5, command.damping, 0.01);
  // Beyond the limit of the transmission.
  EXPECT_NEAR(-3.0, decode_command(b.cycle(GAITD_JOINT_MODE_TORQUE, 400), kRanges).torque, 0.01);
  const Frame damped = b.cycle(GAITD_JOINT_MODE_DAMPING);
  EXPECT_TRUE(is_torque_free(damped));
  EXPECT_FALSE(decode_special(damped));
  // Figures that are none never become torque.
  b.write(GAITD_JOINT_MODE_TORQUE, std::nan(""));
  EXPECT_TRUE(is_torque_free(b.wire.take().at(0)));
  b.robot->stop();
  const std::vector<Frame> last = b.wire.take();
  ASSERT_EQ(3u, last.size());
  for (const Frame& frame : last) EXPECT_EQ(Special::kDisable, decode_special(frame));
}

TEST(CanRobot, CountsRepliesThatAreMissingLateAndDuplicate) {
  Bench b;
  const auto health = [&] {
    GaitdHealth h;
    b.robot->health(&h);
    return h;
  };
  b.cycle(GAITD_JOINT_MODE_OFF);
  const GaitdHealth before = health();
  b.write(GAITD_JOINT_MODE_OFF, 0);
  b.read();
  EXPECT_EQ(before.missing + 1, health().missing);
  EXPECT_GT(b.sensors.joints[0].info.age, 0.01);
  b.answer();  // of the cycle before
  b.read();
  EXPECT_EQ(before.late + 1, health().late);
  b.answer();
  b.read();
  EXPECT_EQ(before.duplicate + 1, health().duplicate);
}

TEST(CanRobot, InLockstepTheEndOfAnEarlierCycleEndsNothing) {
  using Clock = std::chrono::steady_clock;
  RobotOptions options;
  options.lockstep = true;
  options.lockstep_timeout = 0.2;
  Bench b(options);
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
  for (const Frame& frame : frames) EXPECT_EQ(Special::kDisable, decode_special(frame));
  b.answer();
  EXPECT_EQ(0u, b.read());
  EXPECT_EQ(Special::kDisable, decode_special(b.cycle(GAITD_JOINT_MODE_DAMPING)));
  EXPECT_EQ(Special::kEnable, decode_special(b.cycle(GAITD_JOINT_MODE_TORQUE, 4)));
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
  const auto unsent = [&] {
    GaitdHealth h;
    b.robot->health(&h);
    return h.unsent;
  };
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

}  // namespace
}  // namespace gaitd::can
