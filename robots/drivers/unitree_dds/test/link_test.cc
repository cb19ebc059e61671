// SPDX-License-Identifier: Apache-2.0
// The backend with its link, over the loopback, against a robot that is this test: what it takes to
// get the robot, and that it is damped whoever dies.
#include <signal.h>

#include "link_bench.h"
#include "remote.h"

namespace gaitd::unitree {
namespace {

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
  EXPECT_TRUE(Robot::wait([&] { return robot.damped(); }, 0.1));
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
  Daemon daemon;
  ASSERT_EQ("", daemon.start());
  ASSERT_TRUE(daemon.drive(&robot));
  daemon.end();
  EXPECT_TRUE(Robot::wait([&] { return robot.damped(); }, 0.1));
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
