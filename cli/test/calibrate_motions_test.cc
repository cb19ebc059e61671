// SPDX-License-Identifier: Apache-2.0
// Motions that are made for a robot: which way its joints swing, and whether gaitd takes them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "cli/calibrate/motions.h"
#include "daemon/config/robot.h"
#include "daemon/config/scenario.h"

namespace gaitd::calibrate {
namespace {

GaitdModel model_of(const std::string& robot) {
  daemon::Settings settings;
  daemon::Issues issues;
  const auto loaded =
      daemon::load_robot(std::string(GAITD_SOURCE_DIR "/robots/") + robot + "/robot.yaml",
                         daemon::Profile::kSimulation, &settings, &issues);
  EXPECT_TRUE(loaded) << issues.error_text();
  return loaded->model;
}

daemon::Scenario scenario_of(const GaitdModel& model) {
  const std::string file = testing::TempDir() + "motions.yaml";
  std::ofstream(file) << motions_yaml(model, model.name);
  daemon::Settings settings;
  daemon::Issues issues;
  const auto scenario = daemon::load_scenario(file, &settings, &issues);
  EXPECT_TRUE(scenario) << issues.error_text();
  return scenario.value_or(daemon::Scenario());
}

// rad, of each joint, in their order.
std::map<std::string, std::vector<double>> swings(const daemon::Scenario& scenario) {
  std::map<std::string, std::vector<double>> all;
  for (const daemon::ScenarioCommand& command : scenario.commands) {
    if (command.method != "joint.test") continue;
    all[command.params.at("joint")].push_back(command.params.at("amplitude"));
  }
  return all;
}

TEST(CalibrateMotions, SwingTheLegsAwayFromEachOtherAndBendTheKnees) {
  const auto of = swings(scenario_of(model_of("atlas")));
  EXPECT_EQ(of.size(), 12u);
  const std::vector<double> outwards_left = {0.2, 0.2}, outwards_right = {-0.2, -0.2};
  EXPECT_EQ(of.at("l_leg_hpx"), outwards_left);
  EXPECT_EQ(of.at("r_leg_hpx"), outwards_right);
  const std::vector<double> bend = {0.3, 0.3}, ahead = {-0.25, -0.25}, both = {0.25, -0.25, -0.25};
  EXPECT_EQ(of.at("l_leg_kny"), bend);
  EXPECT_EQ(of.at("r_leg_hpy"), ahead);
  EXPECT_EQ(of.at("r_leg_akx"), both);
  // Its hip turns inwards by 0.17 rad only, and outwards by 0.79.
  const std::vector<double> turned = {0.25, 0.25};
  EXPECT_EQ(of.at("l_leg_hpz"), turned);
}

TEST(CalibrateMotions, KeepToTheRangesOfTheJoints) {
  GaitdModel model = model_of("atlas");
  const int ankle = model.legs[GAITD_LEFT].ankle_roll;
  model.joints[ankle].position_max = 0.1;
  model.joints[model.legs[GAITD_RIGHT].ankle_roll].position_min = 0.0;
  const auto of = swings(scenario_of(model));
  const std::vector<double> little = {0.08, -0.25, -0.25}, one_way = {0.25, 0.25};
  EXPECT_EQ(of.at("l_leg_akx"), little);
  EXPECT_EQ(of.at("r_leg_akx"), one_way);
}

TEST(CalibrateMotions, GoWithTheSizeOfTheRobot) {
  const daemon::Scenario tall = scenario_of(model_of("atlas"));
  const daemon::Scenario small = scenario_of(model_of("g1"));
  ASSERT_EQ(tall.commands.size(), small.commands.size());
  const double scale = model_of("g1").nominal_com_height / model_of("atlas").nominal_com_height;
  int walks = 0;
  for (std::size_t i = 0; i < tall.commands.size(); ++i) {
    ASSERT_EQ(tall.commands[i].method, small.commands[i].method);
    if (tall.commands[i].method != "walk") continue;
    const double length = tall.commands[i].params.at("length");
    EXPECT_NEAR(small.commands[i].params.at("length").get<double>(), scale * length, 1e-3);
    ++walks;
  }
  EXPECT_EQ(walks, 3);
}

}  // namespace
}  // namespace gaitd::calibrate
