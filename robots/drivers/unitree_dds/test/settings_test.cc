// SPDX-License-Identifier: Apache-2.0
#include "settings.h"

#include <gtest/gtest.h>

#include <cstring>

namespace gaitd::unitree {
namespace {

GaitdModel model_of(std::initializer_list<const char*> joints) {
  GaitdModel model{};
  for (const char* name : joints) {
    std::strncpy(model.joints[model.joint_count++].name, name, GAITD_NAME_SIZE - 1);
  }
  return model;
}

std::string errors_of(const std::string& text, const GaitdModel& model) {
  std::vector<std::string> errors;
  parse_settings(text, model, &errors);
  std::string all;
  for (const std::string& line : errors) all += (all.empty() ? "" : "\n") + line;
  return all;
}

const GaitdModel kLegs = model_of({"waist_pitch_joint", "left_knee_joint"});

TEST(Settings, FindTheMotorsOfJointsByTheirPublishedNames) {
  std::vector<std::string> errors;
  const Settings settings = parse_settings(R"({"interface": "eth0"})", kLegs, &errors);
  EXPECT_TRUE(errors.empty());
  EXPECT_EQ(14, settings.wire[0]);
  EXPECT_EQ(3, settings.wire[1]);
  EXPECT_EQ((uint64_t{1} << 14) | (uint64_t{1} << 3), settings.motor_mask());
  EXPECT_EQ(Control::kDebug, settings.control);
  EXPECT_EQ(0, settings.domain);
}

TEST(Settings, AnInterfaceHasToBeNamed) {
  EXPECT_EQ(
      "unitree_dds.interface: expected the network interface to the robot, such as eth0, got null",
      errors_of("{}", kLegs));
}

TEST(Settings, RefuseWhatTheyDoNotKnow) {
  const auto has = [](const std::string& text, const std::string& part) {
    const std::string errors = errors_of(text, kLegs);
    EXPECT_NE(std::string::npos, errors.find(part)) << errors;
  };
  has(R"({"interface": "lo", "iface": 1})", "iface");
  has(R"({"interface": "lo", "domain": 233})", "unitree_dds.domain: expected");
  has(R"({"interface": "lo", "control": "force"})", "debug, release or user");
  has(R"({"interface": "lo", "damping": 0})", "unitree_dds.damping");
  has(R"({"interface": "lo", "command_timeout": 5})", "unitree_dds.command_timeout");
  has(R"({"interface": "lo", "give_back": 1})", "true or false");
  has(R"({"interface": "lo", "joints": {"head": 3}})", "a joint of the model");
}

TEST(Settings, JointsOfOtherNamesNeedAMotorOfTheirOwn) {
  const GaitdModel model = model_of({"knee", "left_knee_joint"});
  EXPECT_NE(std::string::npos, errors_of(R"({"interface": "lo"})", model).find("joints.knee"));
  EXPECT_NE(
      std::string::npos,
      errors_of(R"({"interface": "lo", "joints": {"knee": 3}})", model).find("a motor of its own"));
  EXPECT_EQ("", errors_of(R"({"interface": "lo", "joints": {"knee": 9}})", model));
}

TEST(Settings, ReachTheLinkAsTheyAre) {
  std::vector<std::string> errors;
  const Settings sent = parse_settings(
      R"({"interface": "eth7", "domain": 3, "control": "user", "give_back": true, "listen": 0.4,
          "command_timeout": 0.03, "state_timeout": 0.06, "rate": 400, "damping": 5,
          "damp_time": 1.5, "mode_machine": 77, "feet": "rt/soles", "lowest_charge": 33})",
      kLegs, &errors);
  EXPECT_TRUE(errors.empty());
  const Settings got = from_text(to_text(sent));
  EXPECT_EQ(to_text(sent), to_text(got));
  EXPECT_EQ(sent.motor_mask(), got.motor_mask());
  EXPECT_EQ("rt/soles", got.feet);
  EXPECT_EQ(77, got.mode_machine);
}

}  // namespace
}  // namespace gaitd::unitree
