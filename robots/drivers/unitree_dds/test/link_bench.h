// SPDX-License-Identifier: Apache-2.0
// A robot and its services on the loopback, and gaitd's side of the link.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "clock.h"
#include "control.h"
#include "crc.h"
#include "packing.h"
#include "unitree_robot.h"

namespace gaitd::unitree {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace): of tests

inline int domain() { return 200 + getpid() % 30; }

// Sends states 500 times a second and keeps what is commanded.
class Robot {
 public:
  Robot() : node_(domain(), "lo") {
    std::memset(&state_, 0, sizeof(state_));
    state_.mode_machine = 5;
    for (int i = 0; i < kMotors; ++i) {
      state_.motor_state[i].mode = 1;
      state_.motor_state[i].q = 0.01f * static_cast<float>(i);
    }
    states_ = node_.writer(kLowState, unitree_hg_msg_dds__LowState__desc);
    commands_ = node_.reader(kLowCmd, unitree_hg_msg_dds__LowCmd__desc, 1, true);
    user_ = node_.reader(kUserLowCmd, unitree_hg_msg_dds__LowCmd__desc, 1, true);
    thread_ = std::thread([this] { run(); });
  }
  ~Robot() {
    over_ = true;
    thread_.join();
  }
  // By the robot's thread, before each state.
  void change(std::function<void(LowState*)> change) {
    const std::lock_guard lock(mutex_);
    change_ = std::move(change);
  }
  LowCmd last() {
    const std::lock_guard lock(mutex_);
    return last_;
  }
  bool damped() {
    const LowCmd command = last();
    bool damped = command.motor_cmd[3].mode == 1;
    for (const MotorCmd& motor : command.motor_cmd) {
      damped = damped && motor.kp == 0 && motor.tau == 0 && motor.dq == 0;
    }
    return damped;
  }
  bool driven() { return last().motor_cmd[3].mode == 1 && last().motor_cmd[3].tau != 0; }
  static bool wait(const std::function<bool()>& reached, double seconds = 5) {
    const int64_t end = monotonic_ns() + static_cast<int64_t>(1e9 * seconds);
    while (!reached()) {
      if (monotonic_ns() > end) return false;
      std::this_thread::sleep_for(1ms);
    }
    return true;
  }
  DdsNode& node() { return node_; }
  std::atomic<int> heard{0}, heard_user{0}, wrong{0};

 private:
  void run() {
    LowCmd command;
    std::memset(&command, 0, sizeof(command));
    while (!over_) {
      {
        const std::lock_guard lock(mutex_);
        state_.tick += 2;
        state_.crc = 0;
        if (change_) change_(&state_);
        if (state_.crc == 0) state_.crc = message_crc(state_);
        dds_write(states_, &state_);
        for (const dds_entity_t reader : {commands_, user_}) {
          while (take_sample(reader, &command)) {
            if (command.crc != message_crc(command) || command.mode_machine != 5) ++wrong;
            ++(reader == user_ ? heard_user : heard);
            last_ = command;
          }
        }
      }
      std::this_thread::sleep_for(2ms);
    }
  }

  DdsNode node_;
  dds_entity_t states_, commands_, user_;
  LowState state_;
  LowCmd last_{};
  std::mutex mutex_;
  std::function<void(LowState*)> change_;
  std::atomic<bool> over_{false};
  std::thread thread_;
};

// The services of a robot with its built-in walking.
class Services {
 public:
  explicit Services(Robot* robot) : node_(robot->node()) {
    for (int i = 0; i < 2; ++i) {
      const std::string base = std::string("rt/api/") + (i == 0 ? "motion_switcher" : "sport");
      requests_[i] =
          node_.reader((base + "/request").c_str(), unitree_api_msg_dds__Request__desc, 10);
      answers_[i] = node_.writer((base + "/response").c_str(), unitree_api_msg_dds__Response__desc);
    }
    thread_ = std::thread([this] {
      while (!over_) {
        answer(0);
        answer(1);
        std::this_thread::sleep_for(2ms);
      }
    });
  }
  ~Services() {
    over_ = true;
    thread_.join();
  }
  std::string calls() {
    const std::lock_guard lock(mutex_);
    return calls_;
  }
  std::atomic<int> code{0};

 private:
  void answer(int service) {
    void* sample = nullptr;
    dds_sample_info_t info;
    while (dds_take(requests_[service], &sample, &info, 1, 1) > 0) {
      const auto& request = *static_cast<const Request*>(sample);
      if (info.valid_data) {
        const std::lock_guard lock(mutex_);
        const auto call = request.header.identity.api_id;
        calls_ += std::to_string(call) + request.parameter + " ";
        if (call == api::kReleaseMode) mode_ = "";
        std::string data = call == api::kCheckMode ? "{\"name\":\"" + mode_ + "\"}" : "";
        Response response;
        std::memset(&response, 0, sizeof(response));
        response.header.identity = request.header.identity;
        response.header.status.code = code;
        response.data = data.data();
        dds_write(answers_[service], &response);
      }
      dds_return_loan(requests_[service], &sample, 1);
      sample = nullptr;
    }
  }

  DdsNode& node_;
  dds_entity_t requests_[2], answers_[2];
  std::mutex mutex_;
  std::string calls_, mode_ = "ai";
  std::atomic<bool> over_{false};
  std::thread thread_;
};

struct Daemon {
  GaitdModel model{};
  Settings settings;
  std::mutex mutex;
  std::string lines;
  std::unique_ptr<UnitreeRobot> robot;
  GaitdSensors sensors{};
  pid_t link = -1;

  Daemon() {
    settings.interface = "lo";
    settings.domain = domain();
    settings.listen = 0.2;
    settings.damp_time = 0.5;
    settings.command_timeout = 0.1;
    settings.state_timeout = 0.5;
    for (const int i : {3, 9}) {
      GaitdJoint& joint = model.joints[model.joint_count];
      std::strcpy(joint.name, kJointNames[i]);
      joint.position_min = -1;
      joint.position_max = 1;
      joint.velocity_limit = 10;
      joint.effort_limit = 50;
      settings.wire[model.joint_count++] = i;
    }
    settings.joint_count = model.joint_count;
    model.imu_count = 1;
  }
  // The link damps on for a while: not into the next test.
  ~Daemon() {
    if (robot) end();
    if (link > 0) waitpid(link, nullptr, 0);
  }
  void end() {
    link = robot->link();
    robot.reset();
  }
  // "" or why it does not start.
  std::string start() {
    RobotOptions options;
    options.link_program = LINK_PROGRAM;
    robot = std::make_unique<UnitreeRobot>(settings, model, options, [this](int, const auto& line) {
      const std::lock_guard lock(mutex);
      lines += line + "\n";
    });
    std::vector<std::string> errors;
    if (robot->start(&errors)) return "";
    std::string text;
    for (const std::string& line : errors) text += line + "\n";
    return text;
  }
  void command(int mode, double torque = 0) {
    GaitdJointCommands commands{};
    commands.joint_count = model.joint_count;
    for (int i = 0; i < model.joint_count; ++i) {
      commands.joints[i].mode = mode;
      commands.joints[i].torque = torque;
      commands.joints[i].damping = 1;
    }
    robot->write(commands);
  }
  uint32_t read() {
    robot->read(&sensors);
    GaitdHealth health{};
    robot->health(&health);
    text = health.text;
    return health.conditions;
  }
  // Drives until it shows at the robot.
  bool drive(Robot* peer) {
    return Robot::wait([&] {
      command(GAITD_JOINT_MODE_TORQUE, 4);
      return peer->driven();
    });
  }
  bool finds(uint32_t condition) {
    return Robot::wait([&] { return (read() & condition) != 0; });
  }
  std::string text;
};

}  // namespace gaitd::unitree
