// SPDX-License-Identifier: Apache-2.0
#include "ros2/robot_messages.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>

namespace gaitd::ros2 {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using nlohmann::json;

class RobotMessagesTest : public ::testing::Test {
 protected:
  RobotMessagesTest() {
    std::ifstream file(std::string(GAITD_SOURCE_DIR) + "/robots/atlas/atlas.urdf");
    std::stringstream text;
    text << file.rdbuf();
    const auto foot = [](const char* link, double y) {
      return json{{"link", link}, {"sole", {{"xyz", {0.0426, y, -0.07645}}, {"rpy", {0, 0, 0}}}}};
    };
    robot_ = {{"name", "atlas"},
              {"urdf", text.str()},
              {"log", {{"pelvis", "pelvis"}}},
              {"robot",
               {{"feet", {{"left", foot("l_foot", 0.0017)}, {"right", foot("r_foot", -0.0017)}}}}}};
    urdf_ = dynamics::load_urdf_text(text.str());
    for (const char* name :
         {"x", "y", "z", "roll", "pitch", "yaw", "velocity/x", "velocity/y", "velocity/z",
          "angular_velocity/x", "angular_velocity/y", "angular_velocity/z"}) {
      add(std::string("pelvis/") + name);
    }
    for (const char* side : kSides) {
      for (const char* name : {"roll", "pitch", "yaw", "force/x", "force/y", "force/z", "moment/x",
                               "moment/y", "moment/z"}) {
        add(std::string("foot/") + side + "/" + name);
      }
    }
    for (int i = 0; i < urdf_.model.joint_count; ++i) {
      for (const char* name : {"position", "velocity", "torque"}) {
        add(std::string("joint/") + urdf_.model.joints[i].name + "/" + name);
      }
    }
    values_.assign(table_.size(), 0.0);
  }

  void add(const std::string& name) { table_.push_back({.name = name, .unit = "", .words = {}}); }
  void set(const std::string& name, double value) {
    const int i = find_signal(table_, name);
    ASSERT_GE(i, 0) << name;
    values_[static_cast<std::size_t>(i)] = value;
  }
  void stand() {
    set("pelvis/z", 0.9242);
    for (const char* leg : {"l", "r"}) {
      const std::string prefix = std::string("joint/") + leg + "_leg_";
      set(prefix + "hpy/position", -0.2240);
      set(prefix + "kny/position", 0.5);
      set(prefix + "aky/position", -0.2760);
    }
  }
  std::unique_ptr<RobotMessages> create() {
    std::string error;
    auto messages = RobotMessages::create(robot_, table_, &error);
    EXPECT_TRUE(messages) << error;
    return messages;
  }

  json robot_;
  dynamics::UrdfResult urdf_;
  daemon::SignalTable table_;
  std::vector<double> values_;
};

// Frame to parent and pose in it.
std::map<std::string, std::pair<std::string, Isometry3d>> frames(RobotMessages* messages) {
  std::map<std::string, std::pair<std::string, Isometry3d>> result;
  for (const auto* message : {&messages->transforms(), &messages->fixed_transforms({})}) {
    for (std::uint32_t i = 0; i < message->transforms._length; ++i) {
      const auto& one = message->transforms._buffer[i];
      const auto& q = one.transform.rotation;
      Isometry3d X(Eigen::Quaterniond(q.w, q.x, q.y, q.z));
      const auto& p = one.transform.translation;
      X.translation() = Vector3d(p.x, p.y, p.z);
      EXPECT_FALSE(result.contains(one.child_frame_id)) << one.child_frame_id;
      result[one.child_frame_id] = {one.header.frame_id, X};
    }
  }
  return result;
}

Isometry3d in_odom(const std::map<std::string, std::pair<std::string, Isometry3d>>& tree,
                   const std::string& name) {
  if (name == kOdometryFrame) return Isometry3d::Identity();
  const auto& [parent, X] = tree.at(name);
  return in_odom(tree, parent) * X;
}

TEST_F(RobotMessagesTest, EveryFrameIsWhereTheKinematicsHaveIt) {
  stand();
  set("pelvis/x", 3.0);
  set("pelvis/yaw", 0.7);
  set("pelvis/roll", -0.1);
  set("joint/l_arm_shx/position", -1.3);
  set("joint/back_bkz/position", 0.4);
  const auto messages = create();
  ASSERT_TRUE(messages->read(values_, {5, 6}));
  const auto tree = frames(messages.get());

  dynamics::Kinematics kinematics(urdf_.model);
  Eigen::VectorXd q = Eigen::VectorXd::Zero(urdf_.model.joint_count);
  for (int i = 0; i < urdf_.model.joint_count; ++i) {
    q[i] = values_[static_cast<std::size_t>(
        find_signal(table_, std::string("joint/") + urdf_.model.joints[i].name + "/position"))];
  }
  const Eigen::Quaterniond R =
      Eigen::AngleAxisd(0.7, Vector3d::UnitZ()) * Eigen::AngleAxisd(-0.1, Vector3d::UnitX());
  kinematics.update({3.0, 0.0, 0.9242}, R, dynamics::Vector6d::Zero(), q,
                    Eigen::VectorXd::Zero(q.size()));
  for (const dynamics::UrdfLink& link : urdf_.links) {
    Isometry3d X(link.R_BL);
    X.translation() = link.p_BL;
    EXPECT_TRUE(in_odom(tree, link.name).isApprox(kinematics.X_WB(link.body) * X, 1e-9))
        << link.name;
  }
  EXPECT_EQ(tree.size(), urdf_.links.size() + 2);
  EXPECT_EQ(messages->transforms().transforms._buffer[0].header.stamp.nanosec, 6u);
}

TEST_F(RobotMessagesTest, TheSolesOfARobotThatStandsAreOnTheGround) {
  stand();
  const auto messages = create();
  ASSERT_TRUE(messages->read(values_, {}));
  const auto tree = frames(messages.get());
  const Isometry3d left = in_odom(tree, "left_sole");
  const Isometry3d right = in_odom(tree, "right_sole");
  EXPECT_NEAR(left.translation().z(), 0.0, 1e-3);
  EXPECT_NEAR(right.translation().z(), 0.0, 1e-3);
  EXPECT_NEAR(left.translation().y() - right.translation().y(), 0.2264, 1e-3);
  EXPECT_TRUE(left.linear().isApprox(Eigen::Matrix3d::Identity(), 1e-3));
}

TEST_F(RobotMessagesTest, TwistsAndWrenchesAreInTheAxesOfTheirFrames) {
  set("pelvis/yaw", M_PI / 2.0);
  set("pelvis/velocity/y", 0.5);
  set("pelvis/angular_velocity/x", 0.25);
  set("foot/left/yaw", M_PI / 2.0);
  set("foot/left/force/y", 10.0);
  set("foot/left/moment/x", 3.0);
  const auto messages = create();
  ASSERT_TRUE(messages->read(values_, {}));
  const auto& twist = messages->odometry().twist.twist;
  EXPECT_NEAR(twist.linear.x, 0.5, 1e-12);
  EXPECT_NEAR(twist.linear.y, 0.0, 1e-12);
  EXPECT_NEAR(twist.angular.y, -0.25, 1e-12);
  EXPECT_STREQ(messages->odometry().header.frame_id, "odom");
  EXPECT_STREQ(messages->odometry().child_frame_id, "pelvis");
  EXPECT_NEAR(messages->wrench(0).wrench.force.x, 10.0, 1e-12);
  EXPECT_NEAR(messages->wrench(0).wrench.torque.y, -3.0, 1e-12);
  EXPECT_STREQ(messages->wrench(1).header.frame_id, "right_sole");
}

TEST_F(RobotMessagesTest, JointsStandUnderTheirNames) {
  set("joint/l_leg_kny/position", 0.5);
  set("joint/l_leg_kny/velocity", -2.0);
  set("joint/l_leg_kny/torque", 70.0);
  const auto messages = create();
  ASSERT_TRUE(messages->read(values_, {}));
  const auto& joints = messages->joint_state();
  ASSERT_EQ(joints.name._length, 30u);
  ASSERT_EQ(joints.effort._length, 30u);
  for (std::uint32_t i = 0; i < joints.name._length; ++i) {
    const bool knee = std::string(joints.name._buffer[i]) == "l_leg_kny";
    EXPECT_EQ(joints.position._buffer[i], knee ? 0.5 : 0.0);
    EXPECT_EQ(joints.velocity._buffer[i], knee ? -2.0 : 0.0);
    EXPECT_EQ(joints.effort._buffer[i], knee ? 70.0 : 0.0);
  }
}

TEST_F(RobotMessagesTest, NothingIsToldOfARobotWithoutAPose) {
  const auto messages = create();
  set("pelvis/z", std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(messages->read(values_, {}));
  set("pelvis/z", 1.0);
  set("joint/l_leg_kny/torque", std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(messages->read(values_, {}));
  values_.pop_back();
  EXPECT_FALSE(messages->read(values_, {}));
}

TEST_F(RobotMessagesTest, AGaitdOfAnotherVersionIsRefusedWithTheReason) {
  std::string error;
  for (auto& signal : table_) {
    if (signal.name == "pelvis/velocity/x") signal.name = "other";
  }
  EXPECT_FALSE(RobotMessages::create(robot_, table_, &error));
  EXPECT_NE(error.find("pelvis/velocity/x"), std::string::npos) << error;
  error.clear();
  EXPECT_FALSE(RobotMessages::create({{"urdf", "<nonsense"}}, table_, &error));
  EXPECT_FALSE(error.empty());
}

}  // namespace
}  // namespace gaitd::ros2
