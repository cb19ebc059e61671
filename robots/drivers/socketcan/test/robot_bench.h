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
inline constexpr uint32_t kReplyId = 0x11, kImuId = 0x300, kEstopId = 0x80;

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
  Dialect dialect = Dialect::kMiniCheetah;
  int buses = 1;         // with a motor each
  bool sensors = false;  // an IMU and an e-stop on the first bus
};

struct Bench {
  std::vector<std::unique_ptr<Slcan>> wires;
  Slcan& wire;
  GaitdModel model{};
  TestClocks clocks;
  std::vector<std::string> lines;  // of the log
  std::unique_ptr<CanRobot> robot;
  GaitdSensors sensors{};
  double position = 0.3;  // rad, that the motors show
  const Dialect dialect;

  explicit Bench(const Kit& kit = {})
      : wires(make_wires(kit.buses)), wire(*wires[0]), dialect(kit.dialect) {
    model.joint_count = kit.buses;
    Wiring wiring;
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
    const auto request = decode_register_read(frame);
    if (!request) return answer(bus);
    RegisterValue value = *request;
    if (value.address == Register::kPositionRange) value.raw = raw_of(12.5f);
    if (value.address == Register::kVelocityRange) value.raw = raw_of(30.0f);
    if (value.address == Register::kTorqueRange) value.raw = raw_of(10.0f);
    if (value.address == Register::kTimeout) value.raw = 2000;
    if (value.address == Register::kControlMode) value.raw = kMitControlMode;
    wires[bus]->send(encode_register_answer(kReplyId, value));
  }
  void answer(int bus = 0) {
    MotorReply reply;
    reply.motor = 1;
    reply.position = position;
    wires[bus]->send(
        encode_reply(dialect == Dialect::kMiniCheetah ? 0 : kReplyId, reply, dialect, kRanges));
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

}  // namespace gaitd::can
