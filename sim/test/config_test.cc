// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "block_model.h"
#include "gaitd/sim/config.h"
#include "gaitd/terrain/height_map_file.h"

namespace gaitd::sim {
namespace {

std::vector<std::string> errors_of(const std::string& text, double period = 0.001) {
  std::vector<std::string> errors;
  parse_config(text, test::block_model(), period, &errors);
  return errors;
}

TEST(Config, ReadsTheStiffnessOfTheGround) {
  std::vector<std::string> errors;
  const GaitdModel model = test::block_model();
  const auto read = [&](const std::string& terrain) {
    return parse_config("{\"terrain\": {\"ground_z\": 0" + terrain + "}}", model, 0.001, &errors);
  };
  EXPECT_FALSE(read("").terrain.stiffness);
  EXPECT_EQ(read(", \"stiffness\": 1e6").terrain.stiffness, 1e6);
  EXPECT_TRUE(errors.empty());
  read(", \"stiffness\": 100");
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_NE(errors[0].find("terrain.stiffness"), std::string::npos) << errors[0];
}

TEST(Config, EverythingIsRead) {
  std::vector<std::string> errors;
  const Config config = parse_config(
      R"({"start": {"x": 1, "y": 2, "z": 0.5, "yaw": 0.3}, "seed": 9, "time_step": 0.00025,
          "terrain": {"friction": 0.7, "ground_z": -1,
                      "boxes": [{"center": [1, 2, 3], "size": [1, 1, 1], "rpy": [0, 0.1, 0]},
                                {"center": [0, 0, 0], "size": [1, 2, 1], "friction": 0.2}]},
          "sensors": {"noise": {"gyro_noise": 0.1, "delay": 0.002}, "episode": 2},
          "actuators": {"model": "nominal"},
          "model_error": {"mass_scale": {"block": 1.1}, "com_offset": {"block": [0, 0, 0.1]},
                          "inertia_scale": {"block": 2}, "friction": 0.5}})",
      test::block_model(), 0.001, &errors);
  EXPECT_TRUE(errors.empty()) << errors[0];
  EXPECT_EQ(config.start.x, 1);
  EXPECT_EQ(config.start.z, 0.5);
  EXPECT_EQ(config.seed, 9u);
  EXPECT_EQ(config.time_step, 0.00025);
  EXPECT_EQ(config.terrain.ground_z, -1);
  ASSERT_EQ(config.terrain.boxes.size(), 2u);
  EXPECT_EQ(config.terrain.boxes[0].friction, 0.7);
  EXPECT_EQ(config.terrain.boxes[0].rpy.y(), 0.1);
  EXPECT_EQ(config.terrain.boxes[1].friction, 0.2);
  EXPECT_EQ(config.sensors.gyro_noise.low(), 0.1);
  EXPECT_EQ(config.sensors.gyro_noise.high(), 0.1);
  EXPECT_EQ(config.sensors.imu_delay.low(), 0.002);
  EXPECT_TRUE(config.sensors.force_noise.zero());
  EXPECT_EQ(config.episode, 2u);
  EXPECT_EQ(config.actuators.bandwidth, 60);
  EXPECT_EQ(config.body_errors[0].mass_scale, 1.1);
  EXPECT_EQ(config.body_errors[0].com_offset.z(), 0.1);
  EXPECT_EQ(config.body_errors[0].inertia_scale, 2);
  EXPECT_EQ(config.friction_scale, 0.5);
}

TEST(Config, AHeightMapIsReadFromItsFile) {
  terrain::HeightMap map(terrain::Grid{5, 4, 0.1, {0, 0}});
  map.set(1, 2, 0.25);
  const std::string file = ::testing::TempDir() + "config-test-map.yaml";
  ASSERT_EQ(terrain::save_height_map(map, file), "");
  std::vector<std::string> errors;
  const Config config =
      parse_config(R"({"terrain": {"ground_z": 0, "height_map": ")" + file + R"("}})",
                   test::block_model(), 0.001, &errors);
  ASSERT_TRUE(errors.empty()) << errors[0];
  ASSERT_NE(config.terrain.height_map, nullptr);
  EXPECT_NEAR(config.terrain.height_map->height(1, 2), 0.25, 1e-9);
  const auto wrong = errors_of(R"({"terrain": {"ground_z": 0, "height_map": "/no/map.yaml"}})");
  ASSERT_EQ(wrong.size(), 1u);
  EXPECT_NE(wrong[0].find("terrain.height_map: /no/map.yaml: expected"), std::string::npos);
  EXPECT_EQ(errors_of(R"({"terrain": {"ground_z": 0, "height_map": 3}})").size(), 1u);
}

TEST(Config, EveryMistakeIsNamedAtOnce) {
  const std::vector<std::string> errors = errors_of(
      R"({"start": {"x": "left", "w": 1}, "seed": -3, "time_step": 0.0003, "gravity": 9.81,
          "terrain": {"friction": -1, "boxes": [{"center": [0, 0], "size": [1, 0, 1]}, 7]},
          "sensors": {"noise": "some", "episode": 0.5},
          "actuators": {"model": {"bandwith": 60, "torque_noise": 2}},
          "model_error": {"mass_scale": {"head": 1.1, "block": 0}}})");
  const std::vector<std::string> expected = {"gravity: ",
                                             "seed: ",
                                             "time_step: ",
                                             "start.w: ",
                                             "start.x: ",
                                             "start.z: ",
                                             "terrain.friction: ",
                                             "terrain.boxes[0].center: ",
                                             "terrain.boxes[0].size: ",
                                             "terrain.boxes[1]: ",
                                             "sensors.noise: ",
                                             "sensors.episode: ",
                                             "actuators.model.bandwith: ",
                                             "actuators.model.torque_noise: ",
                                             "model_error.mass_scale.head: ",
                                             "model_error.mass_scale.block: "};
  std::string all;
  for (const std::string& error : errors) all += error + "\n";
  for (const std::string& start : expected) {
    bool found = false;
    for (const std::string& error : errors) {
      found = found || (error.rfind(start, 0) == 0 && error.find("expected ") != error.npos &&
                        error.find(", got ") != error.npos);
    }
    EXPECT_TRUE(found) << start << " in\n" << all;
  }
}

TEST(Config, SensorsAreAClassOrFiguresOrBoth) {
  std::vector<std::string> errors;
  const auto sensors = [&](const std::string& noise) {
    return parse_config(R"({"terrain": {"ground_z": 0}, "sensors": {"noise": )" + noise + "}}",
                        test::block_model(), 0.001, &errors)
        .sensors;
  };
  EXPECT_TRUE(sensors(R"("none")").imu_delay.zero());
  EXPECT_EQ(sensors(R"("nominal")").force_noise.low(), 5);
  EXPECT_EQ(sensors(R"("lab")").imu_filter.low(), 250);
  EXPECT_TRUE(sensors(R"("rough")").arrival_stamps);
  const SensorFigures mixed =
      sensors(R"({"class": "rough", "delay": [0.001, 0.002], "imu_delay": 0.004, "spike_rate": 0,
                  "stamp": "measurement"})");
  EXPECT_EQ(mixed.joint_delay.low(), 0.001);
  EXPECT_EQ(mixed.foot_delay.high(), 0.002);
  EXPECT_EQ(mixed.imu_delay.high(), 0.004);
  EXPECT_TRUE(mixed.spike_rate.zero());
  EXPECT_FALSE(mixed.arrival_stamps);
  EXPECT_EQ(mixed.force_jump.low(), 5);
  EXPECT_TRUE(errors.empty()) << errors[0];

  std::vector<std::string> paths;
  for (const std::string& error : errors_of(R"({"terrain": {"ground_z": 0}, "sensors": {"noise": {
      "class": "loud", "stamp": "never", "gyro_nois": 1, "gyro_noise": -1, "gyro_bias": [1],
      "delay": [0.002, 0.001], "imu_delay": [0, 1], "lost_burst": 0, "joint_zero": "big"}}})")) {
    EXPECT_NE(error.find(": expected "), error.npos) << error;
    paths.push_back(error.substr(0, error.find(": ")));
  }
  EXPECT_EQ(paths,
            (std::vector<std::string>{
                "sensors.noise.gyro_nois", "sensors.noise.class", "sensors.noise.stamp",
                "sensors.noise.delay", "sensors.noise.joint_zero", "sensors.noise.gyro_noise",
                "sensors.noise.gyro_bias", "sensors.noise.imu_delay", "sensors.noise.lost_burst"}));
}

TEST(Config, DrivesAreAClassOrFiguresOfOne) {
  std::vector<std::string> errors;
  const auto drives = [&](const std::string& model) {
    return parse_config(R"({"terrain": {"ground_z": 0}, "actuators": {"model": )" + model + "}}",
                        test::block_model(), 0.001, &errors)
        .drives;
  };
  EXPECT_FALSE(drives(R"("nominal")"));
  EXPECT_EQ(drives(R"("harmonic")")->elasticity, Elasticity::kJoints);
  const auto mixed = drives(R"({"class": "hydraulic", "elasticity": "hips", "backlash": [0, 0.01],
                                "hip_damping": 2, "lost_commands": 0.1, "cogging": 0.01})");
  EXPECT_TRUE(errors.empty()) << errors[0];
  EXPECT_EQ(mixed->elasticity, Elasticity::kHips);
  EXPECT_EQ(mixed->backlash.high(), 0.01);
  EXPECT_EQ(mixed->hip_damping, 2);
  EXPECT_EQ(mixed->lost_commands.low(), 0.1);
  EXPECT_EQ(mixed->cogging, 0.01);
  EXPECT_EQ(mixed->stiffness, DriveFigures::hydraulic().stiffness);
  drives(R"({"class": "hydraulic", "elasticity": "knees", "backlash": -1, "cogging": [0, 1],
             "lost_command_burst": 0})");
  ASSERT_EQ(errors.size(), 4u);
  EXPECT_EQ(errors[0],
            "actuators.model.elasticity: expected measured, hips or joints, got \"knees\"");
}

TEST(Config, TextThatIsNoJsonAndTerrainWithoutGroundAreRefused) {
  EXPECT_EQ(errors_of("{").size(), 1u);
  EXPECT_EQ(errors_of("[1]")[0].rfind("configuration: expected an object", 0), 0u);
  EXPECT_EQ(errors_of("{}")[0].rfind("start.z: ", 0), 0u);
  EXPECT_TRUE(errors_of(R"({"terrain": {"ground_z": 0}})").empty());
  EXPECT_TRUE(errors_of(R"({"terrain": {"ground_z": 0}})", 0.004).empty());
  EXPECT_FALSE(errors_of(R"({"terrain": {"ground_z": 0}})", 0.0007).empty());
}

}  // namespace
}  // namespace gaitd::sim
