// SPDX-License-Identifier: Apache-2.0
// The backend and the fake G1 in lock step: the same commands give the same bits, whatever this
// machine does beside them.
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "unitree_robot.h"

extern char** environ;

namespace gaitd::unitree {
namespace {

constexpr int kCycles = 400;

class FakeProcess {
 public:
  explicit FakeProcess(int domain) {
    std::vector<std::string> words = {
        FAKE_G1,      "--lockstep", "--robot",      "g1",   "--domain", std::to_string(domain),
        "--patience", "30",         "--rate-noise", "0.03", "--delay",  "0.002",
        "--report",   "/dev/null"};
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    posix_spawn(&pid_, FAKE_G1, nullptr, nullptr, argv.data(), environ);
  }
  ~FakeProcess() {
    kill(pid_, SIGTERM);
    waitpid(pid_, nullptr, 0);
  }

 private:
  pid_t pid_ = -1;
};

// Everything that is read while the robot sways about its posture.
std::vector<double> sway(int domain) {
  const FakeProcess fake(domain);
  GaitdModel model{};
  model.joint_count = kMotors;
  model.imu_count = 1;
  model.feet[GAITD_LEFT].force_sensor.body = -1;
  Settings settings;
  settings.interface = "lo";
  settings.domain = domain;
  settings.listen = 0.2;
  settings.damp_time = 0.2;
  settings.lockstep_timeout = 30;
  settings.joint_count = kMotors;
  for (int i = 0; i < kMotors; ++i) {
    std::strcpy(model.joints[i].name, kJointNames[i]);
    model.joints[i].position_min = -3;
    model.joints[i].position_max = 3;
    model.joints[i].velocity_limit = 30;
    model.joints[i].effort_limit = 100;
    settings.wire[i] = i;
  }
  RobotOptions options;
  options.lockstep = true;
  options.link_program = LINK_PROGRAM;
  UnitreeRobot robot(settings, model, options, [](int, const std::string&) {});
  std::vector<std::string> errors;
  if (!robot.start(&errors)) {
    ADD_FAILURE() << (errors.empty() ? "no reason" : errors[0]);
    return {};
  }
  std::vector<double> all;
  GaitdSensors sensors{}, first{};
  for (int cycle = 0; cycle < kCycles; ++cycle) {
    EXPECT_EQ(GAITD_OK, robot.read(&sensors));
    if (cycle == 0) first = sensors;
    GaitdJointCommands commands{};
    commands.joint_count = kMotors;
    for (int i = 0; i < kMotors; ++i) {
      const GaitdJointSensor& joint = sensors.joints[i];
      EXPECT_EQ(0.0, joint.info.age);
      all.insert(all.end(), {joint.position, joint.velocity, joint.torque});
      GaitdJointCommand& c = commands.joints[i];
      c.mode = cycle == 0 ? GAITD_JOINT_MODE_DAMPING : GAITD_JOINT_MODE_TORQUE;
      c.position = first.joints[i].position + 0.02 * std::sin(0.05 * cycle);
      c.stiffness = 150;
      c.damping = 4;
    }
    all.insert(all.end(), sensors.imus[0].angular_rate, sensors.imus[0].angular_rate + 3);
    all.insert(all.end(), sensors.imus[0].specific_force, sensors.imus[0].specific_force + 3);
    EXPECT_EQ(GAITD_OK, robot.write(commands));
    EXPECT_EQ(GAITD_OK, robot.advance());
  }
  return all;
}

TEST(FakeG1, GivesTheSameBitsForTheSameCommandsInLockstep) {
  const int domain = 160 + getpid() % 30;
  const std::vector<double> once = sway(domain), again = sway(domain);
  ASSERT_EQ(size_t{kCycles} * (3 * kMotors + 6), once.size());
  ASSERT_EQ(once.size(), again.size());
  // Until the first command has come through, it hangs for as many cycles as the link takes to
  // begin.
  const auto driven = 8 * (3 * kMotors + 6);
  const auto differ =
      std::mismatch(once.begin() + driven, once.end(), again.begin() + driven).first;
  EXPECT_EQ(once.size(), static_cast<size_t>(differ - once.begin()));
  // It moved, and noise is in it.
  EXPECT_NE(once[3 * kMotors + 6], once[once.size() / 2]);
}

}  // namespace
}  // namespace gaitd::unitree
