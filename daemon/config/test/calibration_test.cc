// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/calibration.h"

#include <gtest/gtest.h>

#include "daemon/config/node.h"
#include "daemon/config/paths.h"
#include "daemon/config/robot.h"

namespace gaitd::daemon {
namespace {

class CalibrationOfAtlas : public testing::Test {
 protected:
  void SetUp() override {
    Settings settings;
    const auto file = Paths::detect().robot("atlas").value_or("");
    auto robot = load_robot(file.string(), Profile::kSimulation, &settings, &issues_);
    ASSERT_TRUE(robot) << issues_.error_text();
    robot_ = *robot;
  }
  int joint(const std::string& name) const {
    for (int i = 0; i < robot_.model.joint_count; ++i) {
      if (name == robot_.model.joints[i].name) return i;
    }
    return -1;
  }
  std::optional<Calibration> read(const std::string& text) {
    issues_ = {};
    return read_calibration(parse_yaml(text, "calibration.yaml", &issues_), robot_.model, &issues_);
  }
  std::string errors_of(const std::string& text) {
    EXPECT_FALSE(read("schema: gaitd.calibration/1\nrobot: atlas\n" + text)) << text;
    return issues_.error_text();
  }

  Robot robot_;
  Issues issues_;
};

TEST_F(CalibrationOfAtlas, TheShippedOneIsFoundByItsName) {
  load_calibration("hydraulic", &robot_, {}, &issues_);
  ASSERT_TRUE(issues_.ok()) << issues_.error_text();
  EXPECT_EQ(robot_.calibration.joints[joint("l_leg_hpz")].stiffness, 7000.0);
  EXPECT_EQ(robot_.calibration.joints[joint("r_leg_kny")].stiffness, 12000.0);
  EXPECT_EQ(robot_.calibration.feet[GAITD_RIGHT].mass, 2.41);
}

TEST_F(CalibrationOfAtlas, NoneAndUnknownOnes) {
  load_calibration("", &robot_, {}, &issues_);
  EXPECT_TRUE(issues_.ok());
  EXPECT_EQ(robot_.calibration.joints[joint("l_leg_hpz")].stiffness, 0.0);
  load_calibration("hydraulics", &robot_, {}, &issues_);
  EXPECT_NE(issues_.error_text().find("hydraulic"), std::string::npos) << issues_.error_text();
}

TEST_F(CalibrationOfAtlas, LaterGlobsWinFigureByFigure) {
  const auto calibration = read(
      "schema: gaitd.calibration/1\nrobot: atlas\n"
      "joints: {'*': {stiffness: 9000}, l_leg_kny: {zero: 0.02}}\n"
      "feet: {left: {force: [1, 2, 3], moment: [0.1, 0, 0]}}\n");
  ASSERT_TRUE(calibration) << issues_.error_text();
  EXPECT_EQ(calibration->joints[joint("l_leg_kny")].stiffness, 9000.0);
  EXPECT_EQ(calibration->joints[joint("l_leg_kny")].zero, 0.02);
  EXPECT_EQ(calibration->joints[joint("r_leg_kny")].zero, 0.0);
  EXPECT_EQ(calibration->feet[GAITD_LEFT].force[2], 3.0);
}

TEST_F(CalibrationOfAtlas, WhatIsWrongIsNamed) {
  EXPECT_NE(errors_of("joints: {l_leg_knee: {zero: 0.01}}").find("l_leg_knee"), std::string::npos);
  EXPECT_NE(errors_of("joints: {l_leg_kny: {zero: 1.0}}").find("-0.2..0.2 rad"), std::string::npos);
  EXPECT_NE(errors_of("joints: {l_leg_kny: {stiffness: 1}}").find("500"), std::string::npos);
  EXPECT_NE(errors_of("feet: {left: {weight: 2}}").find("weight"), std::string::npos);
  EXPECT_FALSE(read("schema: gaitd.calibration/1\nrobot: talos\n"));
  EXPECT_NE(issues_.error_text().find("talos"), std::string::npos);
  EXPECT_FALSE(read("robot: atlas\n"));
}

}  // namespace
}  // namespace gaitd::daemon
