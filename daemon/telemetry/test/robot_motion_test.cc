// SPDX-License-Identifier: Apache-2.0
#include "daemon/telemetry/robot_motion.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace gaitd::daemon {
namespace {

std::string link(const std::string& name) {
  return "<link name='" + name +
         "'><inertial><mass value='1'/><inertia ixx='0.1' iyy='0.1' izz='0.1' ixy='0' ixz='0' "
         "iyz='0'/></inertial></link>";
}

std::string joint(const std::string& name, const std::string& type, const std::string& parent,
                  const std::string& child, const std::string& xyz, const std::string& inside) {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/><origin xyz='" + xyz + "'/><axis xyz='0 0 1'/>" + inside +
         "</joint>";
}

// A pelvis whose y points forward, a leg beside it, and a finger on it whose range ends at 0.4 rad.
std::unique_ptr<RobotMotion> make() {
  const std::string urdf =
      "<robot name='made'>" + link("pelvis") + link("leg") + link("tip") +
      joint("hip", "revolute", "pelvis", "leg", "0.1 0 -0.5",
            "<limit lower='-1' upper='1' velocity='1' effort='1'/>") +
      joint("finger", "revolute", "leg", "tip", "0.2 0 0", "<limit lower='0.4' upper='2'/>") +
      "</robot>";
  SignalTable table;
  for (const char* name :
       {"pelvis/x", "pelvis/y", "pelvis/z", "pelvis/roll", "pelvis/pitch", "pelvis/yaw",
        "joint/hip/position", "joint/hip/velocity", "joint/hip/torque"}) {
    table.push_back({name, "", SignalDescription::Kind::kReal, {}});
  }
  return RobotMotion::create({{"robot_urdf", urdf},
                              {"pelvis", "pelvis"},
                              {"pelvis_axes", "[0, 0, 0.7071067811865476, 0.7071067811865476]"},
                              {"fixed_joints", "[\"fing*\"]"}},
                             table);
}

TEST(RobotMotion, FramesAreThoseOfTheLinksWhateverAxesThePelvisHas) {
  const auto motion = make();
  ASSERT_NE(motion, nullptr);
  ASSERT_EQ(motion->model().joint_count, 1);
  // The body of the pelvis as the signals give it: x forward, at (1, 2, 3), not turned.
  motion->read(std::vector<double>{1, 2, 3, 0, 0, 0, 0.0, 0.0, 0.0});
  const Eigen::Isometry3d X_WP = motion->X_WP();
  EXPECT_TRUE(X_WP.translation().isApprox(Eigen::Vector3d(1, 2, 3)));
  // Forward is y of the link.
  EXPECT_LT((X_WP.linear().col(1) - Eigen::Vector3d::UnitX()).norm(), 1e-12) << X_WP.linear();
  const Eigen::Isometry3d leg = motion->X_parent(1);
  EXPECT_LT((leg.translation() - Eigen::Vector3d(0.1, 0, -0.5)).norm(), 1e-12)
      << "in the link, as the file has it";
  EXPECT_TRUE(leg.linear().isIdentity(1e-12)) << leg.linear();
  EXPECT_LT((X_WP * leg.translation() - Eigen::Vector3d(1, 1.9, 2.5)).norm(), 1e-12);
}

// The root of the file is the chest; body 0 is the pelvis, with an origin of its own.
TEST(RobotMotion, FramesAreThoseOfTheLinksAlsoAboveATurnedJoint) {
  const std::string urdf = "<robot name='made'>" + link("chest") + link("head") + link("pelvis") +
                           joint("neck", "fixed", "chest", "head", "0 0 0.5", "") +
                           joint("waist", "revolute", "chest", "pelvis", "0.1 0 -0.3",
                                 "<limit lower='-2' upper='2' velocity='1' effort='1'/>") +
                           "</robot>";
  const auto motion = RobotMotion::load(
      {{"robot_urdf", urdf}, {"pelvis", "pelvis"}, {"pelvis_origin", "[0, 0, 0.2]"}});
  ASSERT_NE(motion, nullptr);
  const std::array pelvis = {0.0, 0.0, 1.2, 0.0, 0.0, 0.0};  // of body 0
  motion->place(pelvis, std::array{M_PI_2});
  EXPECT_TRUE(motion->X_WP().translation().isApprox(Eigen::Vector3d(0, 0, 1.0)));
  for (const dynamics::UrdfLink& one : motion->links()) {
    const Eigen::Isometry3d X = motion->X_link(one);
    // The pelvis is turned by a quarter to the left against the chest, so that looks to its right.
    const Eigen::Vector3d expected = one.name == "pelvis"  ? Eigen::Vector3d(0, 0, 1.0)
                                     : one.name == "chest" ? Eigen::Vector3d(0, 0.1, 1.3)
                                                           : Eigen::Vector3d(0, 0.1, 1.8);
    EXPECT_LT((X.translation() - expected).norm(), 1e-12)
        << one.name << ": " << X.translation().transpose();
  }
  const Eigen::Isometry3d chest = motion->X_WP() * motion->X_parent(1);
  EXPECT_LT((chest.translation() - Eigen::Vector3d(0, 0.1, 1.3)).norm(), 1e-12);
}

TEST(RobotMotion, WhatIsFixedIsWhereGaitdTakesItToBe) {
  const auto motion = make();
  ASSERT_NE(motion, nullptr);
  bool found = false;
  for (const dynamics::UrdfLink& one : motion->links()) {
    if (one.name == "pelvis") {
      EXPECT_TRUE(one.R_BL.isApprox(Eigen::Quaterniond::Identity()) ||
                  one.R_BL.isApprox(Eigen::Quaterniond(-1, 0, 0, 0)));
    }
    if (one.name != "tip") continue;
    found = true;
    EXPECT_EQ(one.body, 1);
    EXPECT_TRUE(one.p_BL.isApprox(Eigen::Vector3d(0.2, 0, 0)));
    EXPECT_NEAR(Eigen::AngleAxisd(one.R_BL).angle(), 0.4, 1e-9);
  }
  EXPECT_TRUE(found);
}

}  // namespace
}  // namespace gaitd::daemon
