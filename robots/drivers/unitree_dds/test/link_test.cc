// SPDX-License-Identifier: Apache-2.0
// The backend with its link, over the loopback, against a robot that is this test: what it takes to
// get the robot, and that it is damped whoever dies.
#include <gtest/gtest.h>
#include <signal.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <functional>
#include <mutex>
#include <thread>

#include "clock.h"
#include "control.h"
#include "crc.h"
#include "packing.h"
#include "remote.h"
#include "unitree_robot.h"

namespace gaitd::unitree {
namespace {

using namespace std::chrono_literals;

int domain() { return 200 + getpid() % 30; }

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

TEST(Link, CommandsReachTheRobotAndStatesGaitd) {
  Robot robot;
  Daemon daemon;
  ASSERT_EQ("", daemon.start());
  EXPECT_TRUE(Robot::wait([&] { return robot.damped(); }));  // from the beginning
  EXPECT_NEAR(8, robot.last().motor_cmd[3].kd, 1e-6);
  EXPECT_NEAR(0.03, robot.last().motor_cmd[3].q, 1e-6);
  daemon.command(GAITD_JOINT_MODE_DAMPING);
  EXPECT_TRUE(Robot::wait([&] { return robot.last().motor_cmd[3].kd == 1.0f; }));
  ASSERT_TRUE(daemon.drive(&robot));
  const LowCmd command = robot.last();
  EXPECT_EQ(4.0f, command.motor_cmd[9].tau);
  EXPECT_EQ(1, command.motor_cmd[20].mode);  // no joint of the model: soft
  EXPECT_EQ(0.0f, command.motor_cmd[20].tau);
  EXPECT_EQ(0, command.motor_cmd[29].mode);
  EXPECT_EQ(0u, daemon.read());
  EXPECT_NEAR(0.09, daemon.sensors.joints[1].position, 1e-6);
  EXPECT_EQ(1u, daemon.sensors.joints[1].info.valid);
  EXPECT_LT(daemon.sensors.joints[1].info.age, 0.5);
  EXPECT_EQ(0u, daemon.sensors.feet[0].info.valid);  // it has none
  EXPECT_EQ(0, robot.wrong);
  daemon.robot->stop();
  EXPECT_TRUE(robot.damped());
}

TEST(Link, RefusesARobotThatIsNotThatOfTheModelAndSaysWhy) {
  const auto refusal = [](const std::function<void(LowState*)>& change) {
    Robot robot;
    robot.change(change);
    Daemon daemon;
    daemon.settings.wire[0] = 13;
    const std::string text = daemon.start();
    EXPECT_EQ(0, robot.heard);
    return text;
  };
  const auto has = [](const std::string& text, const std::string& part) {
    EXPECT_NE(std::string::npos, text.find(part)) << text;
  };
  has(refusal([](LowState* s) { s->mode_machine = 6; }),
      "mode_machine 6 (27 joints, waist locked) has no motor for joints of the model: "
      "waist_roll_joint");
  has(refusal([](LowState* s) { s->mode_machine = 0; }), "0 comes from simulators");
  has(refusal([](LowState* s) { s->mode_pr = 1; }), "mode_pr of the robot is not 0");
  has(refusal([](LowState* s) { set_cycle(3, s); }), "--clock lockstep");
}

TEST(Link, RefusesASecondRobot) {
  Robot robot;
  robot.node().writer(kLowState, unitree_hg_msg_dds__LowState__desc);
  Daemon daemon;
  EXPECT_EQ(0u, daemon.start().find("2 writers of rt/lowstate"));
}

TEST(Link, WaitsUntilNobodyElseCommandsAndFaultsWhenSomebodyDoes) {
  Robot robot;
  const dds_entity_t other = robot.node().writer(kLowCmd, unitree_hg_msg_dds__LowCmd__desc);
  LowCmd command;
  std::memset(&command, 0, sizeof(command));
  std::atomic<bool> sending{true}, over{false};
  std::thread writer([&] {
    while (!over) {
      if (sending) dds_write(other, &command);
      std::this_thread::sleep_for(20ms);
    }
  });
  std::thread later([&] {
    std::this_thread::sleep_for(1s);
    sending = false;
  });
  Daemon daemon;
  EXPECT_EQ("", daemon.start());
  EXPECT_FALSE(sending);
  later.join();
  ASSERT_TRUE(daemon.drive(&robot));
  sending = true;
  EXPECT_TRUE(daemon.finds(GAITD_HEALTH_BUS));
  EXPECT_EQ("somebody else commands the robot", daemon.text);
  EXPECT_TRUE(Robot::wait([&] { return robot.damped(); }));
  over = true;
  writer.join();
}

TEST(Link, ReleasesTheBuiltInWalkingAndGivesItBack) {
  Robot robot;
  Services services(&robot);
  Daemon daemon;
  daemon.settings.control = Control::kRelease;
  daemon.settings.give_back = true;
  ASSERT_EQ("", daemon.start());
  EXPECT_EQ("1001{} 1003{} 1001{} ", services.calls());
  daemon.robot->stop();
  EXPECT_TRUE(Robot::wait([&] {
    return services.calls() == "1001{} 1003{} 1001{} 1002{\"name\":\"ai\"} ";
  })) << services.calls();
}

TEST(Link, LetsTheBuiltInWalkingPassCommandsOn) {
  Robot robot;
  Services services(&robot);
  Daemon daemon;
  daemon.settings.control = Control::kUser;
  ASSERT_EQ("", daemon.start());
  EXPECT_EQ("7110{} ", services.calls());
  ASSERT_TRUE(daemon.drive(&robot));
  EXPECT_EQ(0, robot.heard);
  EXPECT_GT(robot.heard_user, 0);
  daemon.robot->stop();
  EXPECT_TRUE(Robot::wait([&] { return services.calls() == "7110{} 7111{\"data\":1} "; }));
  services.code = 7005;
  Daemon refused;
  refused.settings.control = Control::kUser;
  refused.settings.listen = 1;
  EXPECT_NE(std::string::npos, refused.start().find("SwitchToUserCtrl: 7005"));
}

TEST(Link, TheRemoteDampsAtOnceAndIsTold) {
  Robot robot;
  Daemon daemon;
  ASSERT_EQ("", daemon.start());
  ASSERT_TRUE(daemon.drive(&robot));
  robot.change([](LowState* s) {
    s->wireless_remote[2] = kL2;
    s->wireless_remote[3] = kB >> 8;
  });
  // Also under a controller that does not look.
  EXPECT_TRUE(Robot::wait([&] {
    daemon.command(GAITD_JOINT_MODE_TORQUE, 4);
    return robot.damped();
  }));
  EXPECT_TRUE(daemon.finds(GAITD_HEALTH_ESTOP));
  EXPECT_EQ("the remote asks for damping (L2+B)", daemon.text);
}

TEST(Link, DampsUnderAControllerThatHangs) {
  Robot robot;
  Daemon daemon;
  ASSERT_EQ("", daemon.start());
  ASSERT_TRUE(daemon.drive(&robot));
  EXPECT_TRUE(Robot::wait([&] { return robot.damped(); }));
  EXPECT_TRUE(daemon.finds(GAITD_HEALTH_BUS));
  EXPECT_EQ("the controller was late, and the robot damped", daemon.text);
  // What it commands now is of before it hung.
  for (int i = 0; i < 50; ++i) {
    daemon.command(GAITD_JOINT_MODE_TORQUE, 4);
    std::this_thread::sleep_for(2ms);
  }
  EXPECT_TRUE(robot.damped());
  daemon.command(GAITD_JOINT_MODE_DAMPING);
  EXPECT_TRUE(Robot::wait([&] { return daemon.read() == 0; }));
  EXPECT_TRUE(daemon.drive(&robot));
}

TEST(Link, AnotherLinkDampsWhenItIsKilled) {
  Robot robot;
  Daemon daemon;
  ASSERT_EQ("", daemon.start());
  ASSERT_TRUE(daemon.drive(&robot));
  kill(daemon.robot->link(), SIGKILL);
  EXPECT_TRUE(Robot::wait([&] {
    daemon.command(GAITD_JOINT_MODE_TORQUE, 4);
    return robot.damped();
  }));
  EXPECT_TRUE(daemon.finds(GAITD_HEALTH_BUS));
  EXPECT_NE(std::string::npos, daemon.text.find("died")) << daemon.text;
}

TEST(Link, DampsForAWhileAndEndsWhenGaitdIsGone) {
  Robot robot;
  pid_t link;
  {
    Daemon daemon;
    ASSERT_EQ("", daemon.start());
    ASSERT_TRUE(daemon.drive(&robot));
    link = daemon.robot->link();
  }
  EXPECT_TRUE(robot.damped());
  const int before = robot.heard;
  std::this_thread::sleep_for(200ms);
  EXPECT_GT(robot.heard, before + 20);
  EXPECT_TRUE(robot.damped());
  EXPECT_TRUE(Robot::wait([&] {
    const int heard = robot.heard;
    std::this_thread::sleep_for(100ms);
    return heard == robot.heard;
  }));
  EXPECT_TRUE(robot.damped());
  (void)link;
}

TEST(Link, SilenceOfTheRobotIsOldReadingsAndThenAFault) {
  Robot robot;
  Daemon daemon;
  daemon.settings.state_timeout = 0.3;
  ASSERT_EQ("", daemon.start());
  robot.change([](LowState* s) { s->crc = 1; });
  EXPECT_TRUE(daemon.finds(GAITD_HEALTH_BUS));
  EXPECT_GT(daemon.sensors.joints[0].info.age, 0.25);
  GaitdHealth health{};
  daemon.robot->health(&health);
  EXPECT_GT(health.stale, 20u);
}

}  // namespace
}  // namespace gaitd::unitree
