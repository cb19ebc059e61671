// SPDX-License-Identifier: Apache-2.0
// A robot on slcan: the test is its motors and sensors, and its clocks.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "can_robot.h"
#include "sensor_frames.h"
#include "slcan.h"

namespace gaitd::can {

inline const Ranges kRanges{12.5, 30, 10, 500, 5};
inline constexpr uint32_t kReplyId = 0x91, kImuId = 0x300, kEstopId = 0x80;

// Time passes, and what waits comes to pass, as a test wants it.
struct TestClocks : Clocks {
  int64_t passed = 0;              // ns
  std::optional<int64_t> stopped;  // since then it passes only so
  std::function<void()> while_asleep;
  int64_t monotonic_ns() const override {
    return stopped.value_or(Clocks::monotonic_ns()) + passed;
  }
  int64_t realtime_ns() const override { return Clocks::realtime_ns() + passed; }
  void sleep(double seconds) override {
    passed += static_cast<int64_t>(1e9 * seconds);
    if (while_asleep) while_asleep();
  }
};

struct Kit {
  RobotOptions options;
  const Dialect* dialect = &kMiniCheetah;
  int buses = 1;         // with a motor each
  bool sensors = false;  // an IMU and an e-stop on the first bus
};

struct Bench {
  std::vector<std::unique_ptr<Slcan>> wires;
  Slcan& wire;
  GaitdModel model{};
  Wiring wiring;
  TestClocks clocks;
  std::vector<std::string> lines;  // of the log
  std::unique_ptr<CanRobot> robot;
  GaitdSensors sensors{};
  double position = 0.3;                // rad, that the motors show
  MotorError error = MotorError::kOff;  // that they tell, where the dialect can
  const Dialect& dialect;
  const MotorId motor{1, kReplyId};

  explicit Bench(const Kit& kit = {})
      : wires(make_wires(kit.buses)), wire(*wires[0]), dialect(*kit.dialect) {
    model.joint_count = kit.buses;
    for (int i = 0; i < kit.buses; ++i) {
      std::snprintf(model.joints[i].name, GAITD_NAME_SIZE, "knee%d", i);
      wiring.buses.push_back({"leg" + std::to_string(i), wires[i]->name(), {}});
      Motor motor;
      motor.joint = i;
      motor.bus = i;
      motor.id = 1;
      motor.reply_id = kReplyId;
      motor.dialect = kit.dialect;
      motor.ranges = kRanges;
      motor.sign = -1;
      motor.gear = 2;
      motor.torque_limit = 6;
      motor.velocity_limit = 10;
      motor.position_min = -1;
      motor.position_max = 1;
      wiring.motors.push_back(motor);
    }
    if (kit.sensors) {
      model.imu_count = 1;
      std::strcpy(model.imus[0].name, "pelvis_imu");
      wiring.imus.push_back({0, kImuId, 0});
      wiring.estop = {0, kEstopId, 0};
      wiring.heartbeat = 100;
    }
    RobotOptions options = kit.options;
    options.clocks = &clocks;
    robot = std::make_unique<CanRobot>(
        wiring, model, options, [this](int, const std::string& line) { lines.push_back(line); });
    std::atomic<bool> started{false};
    std::thread starting([&] {
      std::vector<std::string> errors;
      EXPECT_TRUE(robot->start(&errors)) << errors[0];
      started = true;
    });
    while (!started) {
      for (int i = 0; i < kit.buses; ++i) {
        for (const Frame& frame : wires[i]->take()) respond(i, frame);
      }
    }
    starting.join();
  }
  static std::vector<std::unique_ptr<Slcan>> make_wires(int count) {
    std::vector<std::unique_ptr<Slcan>> wires;
    for (int i = 0; i < count; ++i) wires.push_back(std::make_unique<Slcan>());
    return wires;
  }
  void respond(int bus, const Frame& frame) {
    const auto request =
        dialect.registers.empty() ? std::nullopt : dialect.read_register_request(frame);
    if (!request) return answer(bus);
    RegisterValue value = *request;
    for (const Register& entry : dialect.registers) {
      if (entry.address != value.address) continue;
      value.raw = fitting_value(entry, kRanges, 0.1);
    }
    wires[bus]->send(dialect.register_answer(motor, value));
  }
  void answer(int bus = 0) {
    MotorReply reply;
    reply.position = position;
    reply.error = static_cast<uint8_t>(error);
    wires[bus]->send(dialect.reply(motor, kRanges, reply));
  }
  // What a motor of this dialect does when it hears this.
  void obey(const Frame& frame) {
    if (special_of(frame) == Special::kEnable) error = MotorError::kOn;
    if (special_of(frame) == Special::kDisable) error = MotorError::kOff;
  }
  GaitdHealth health() const {
    GaitdHealth health;
    robot->health(&health);
    return health;
  }
  uint32_t read() {
    robot->read(&sensors);
    return health().conditions;
  }
  void write(int mode, double torque) {
    GaitdJointCommands commands{};
    commands.joint_count = model.joint_count;
    for (int i = 0; i < model.joint_count; ++i) {
      commands.joints[i].mode = mode;
      commands.joints[i].torque = torque;
      commands.joints[i].damping = 2;
    }
    robot->write(commands);
  }
  std::optional<Special> special_of(const Frame& frame) const {
    return dialect.read_special(frame);
  }
  // The one frame of a cycle.
  Frame cycle(int mode, double torque = 0) {
    write(mode, torque);
    const std::vector<Frame> frames = wire.take();
    EXPECT_EQ(1u, frames.size());
    for (const Frame& frame : frames) obey(frame);
    answer();
    EXPECT_EQ(0u, read());
    return frames.empty() ? Frame{} : frames[0];
  }
};

}  // namespace gaitd::can
