// SPDX-License-Identifier: Apache-2.0
// Height maps as the terrain of scenarios.
#include <gtest/gtest.h>

#include <cmath>

#include "daemon/config/paths.h"
#include "daemon/config/robot.h"
#include "daemon/config/scenario.h"
#include "daemon/config/scenario_ground.h"
#include "daemon/config/test/temporary_folder.h"
#include "gaitd/terrain/height_map_file.h"

namespace gaitd::daemon {
namespace {

class ScenarioTerrain : public ::testing::Test {
 protected:
  ScenarioTerrain() {
    terrain::HeightMap map(terrain::Grid{100, 60, 0.05, {-1.0, -1.5}});
    for (int j = 0; j < 60; ++j) {
      for (int i = 0; i < 100; ++i) map.set(i, j, map.grid().centre(i, j).x() < 1.0 ? 0.2 : 0.4);
    }
    map.set(99, 59, terrain::HeightMap::kUnknown);
    folder_.write("maps/.keep", "");
    EXPECT_EQ(terrain::save_height_map(map, (folder_.path() / "maps/step.yaml").string()), "");
  }

  std::optional<Scenario> read(const std::string& text, Issues* issues) {
    const std::string file = folder_.write(
        "test.yaml", "schema: gaitd.scenario/1\nname: test\nrobot: atlas\nduration: 10\n" + text);
    Settings settings;
    return load_scenario(file, &settings, issues);
  }
  std::string errors_of(const std::string& text) {
    Issues issues;
    read(text, &issues);
    return issues.error_text();
  }

  TemporaryFolder folder_;
};

TEST_F(ScenarioTerrain, ASensorThatSeesItHasAClassAndAPlace) {
  const std::string ground = "terrain: {ground_z: 0}\n";
  Issues issues;
  const auto scenario =
      read(ground +
               "perception: {sensor: lidar, far: 6, link: head, position: [0.1, 0, "
               "0.2], rpy: [0, 0.5, 0]}\n",
           &issues);
  ASSERT_TRUE(scenario) << issues.error_text();
  EXPECT_EQ(scenario->perception["sensor"], "lidar");
  EXPECT_EQ(scenario->perception["far"], 6.0);
  EXPECT_EQ(scenario->perception["rpy"][1], 0.5);
  EXPECT_TRUE(read(ground, &issues)->perception.is_null());
  EXPECT_NE(errors_of(ground + "perception: {sensor: radar}\n").find("lidar"), std::string::npos);
  EXPECT_NE(errors_of(ground + "perception: {}\n").find("sensor"), std::string::npos);
  EXPECT_NE(errors_of(ground + "perception: {sensor: lidar, rpy: [0, 0, 0]}\n").find("add link"),
            std::string::npos);
  EXPECT_NE(errors_of(ground + "perception: {sensor: lidar, rate: 3}\n").find("rate"),
            std::string::npos);
}

TEST_F(ScenarioTerrain, AMapIsFoundBesideTheScenarioAndStoodOn) {
  Issues issues;
  const auto scenario = read("terrain: {height_map: maps/step.yaml}\nstart: {x: 2.0}\n", &issues);
  ASSERT_TRUE(scenario) << issues.error_text();
  ASSERT_NE(scenario->height_map, nullptr);
  EXPECT_NEAR(scenario->start.position[2], 0.4, 1e-4);
  EXPECT_EQ(scenario->terrain["height_map"], (folder_.path() / "maps/step.yaml").string());
  EXPECT_FALSE(scenario->terrain.contains("ground_z"));
}

TEST_F(ScenarioTerrain, AMapThatIsMissingIsAnErrorWithItsLine) {
  const std::string error = errors_of("terrain: {height_map: maps/none.yaml}\nstart: {z: 0}\n");
  EXPECT_NE(error.find("test.yaml:5: terrain.height_map: maps/none.yaml: expected the YAML file"),
            std::string::npos)
      << error;
}

TEST_F(ScenarioTerrain, AStartBesideTheMapNeedsAHeight) {
  const std::string error = errors_of("terrain: {height_map: maps/step.yaml}\nstart: {x: 7.0}\n");
  EXPECT_NE(error.find("neither terrain.height_map nor terrain.ground_z"), std::string::npos)
      << error;
}

TEST_F(ScenarioTerrain, AStartInsideTheMapIsAnErrorAndOneAboveItAWarning) {
  Settings settings;
  Issues issues;
  const auto file = Paths::detect().robot("atlas");
  ASSERT_TRUE(file);
  const auto robot = load_robot(file->string(), Profile::kSimulation, &settings, &issues);
  ASSERT_TRUE(robot) << issues.error_text();
  const auto checked = [&](const std::string& start) {
    Issues found;
    const auto scenario = read("terrain: {height_map: maps/step.yaml}\nstart: " + start, &found);
    EXPECT_TRUE(scenario) << found.error_text();
    if (scenario) check_scenario(*scenario, robot->model, &found);
    return found;
  };
  EXPECT_TRUE(checked("{x: 0}\n").ok());
  EXPECT_EQ(checked("{x: 0}\n").warning_text(), "");
  EXPECT_NE(checked("{x: 1.0}\n").error_text().find("inside it"), std::string::npos)
      << "half on the step";
  EXPECT_NE(checked("{x: 0, z: 0.1}\n").error_text().find("above terrain.height_map"),
            std::string::npos);
  EXPECT_NE(checked("{x: 0, z: 0.5}\n").warning_text().find("nothing to stand on"),
            std::string::npos);
}

TEST_F(ScenarioTerrain, TheGroundOfAScenarioIsAllOfIt) {
  Issues issues;
  const auto scenario = read(
      "terrain:\n  ground_z: 0.1\n  height_map: maps/step.yaml\n"
      "  boxes: [{center: [-2, 0, 0.3], size: [0.4, 0.4, 0.6]}]\n",
      &issues);
  ASSERT_TRUE(scenario) << issues.error_text();
  const auto map = ground_map(*scenario);
  ASSERT_NE(map, nullptr);
  EXPECT_NEAR(map->surface({0.5, 0.0})->height, 0.2, 1e-4);
  EXPECT_NEAR(map->surface({2.0, 0.0})->height, 0.4, 1e-4);
  EXPECT_NEAR(map->surface({-2.0, 0.0})->height, 0.6, 1e-9) << "the box";
  EXPECT_NEAR(map->surface({-2.5, 0.5})->height, 0.1, 1e-9) << "the ground beside it";
  EXPECT_NEAR(map->surface({-1.15, 0.0})->height, 0.1, 1e-9);
}

TEST_F(ScenarioTerrain, APlaneNeedsNoMap) {
  Issues issues;
  const auto scenario = read("terrain: {ground_z: 0.1}\n", &issues);
  ASSERT_TRUE(scenario);
  EXPECT_EQ(ground_map(*scenario), nullptr);
}

}  // namespace
}  // namespace gaitd::daemon
